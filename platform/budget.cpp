#include "platform/budget.hpp"

#include <algorithm>
#include <bit>
#include <numeric>

#include "drivers/point.hpp"
#include "ndt/matcher.hpp"
#include "platform/latency_histogram.hpp"
#include "platform/packet_rate.hpp"
#include "platform/pipeline.hpp"
#include "platform/pose_frame_table.hpp"
#include "platform/realtime_thread.hpp"

namespace landfix::platform {
namespace {

constexpr double kRxWakes_ms = 100.0;  // also without packets
constexpr double kBus_bit_per_s = 500e3;
constexpr std::size_t kOrdinaryStack_bytes = std::size_t{8} << 20;

double fastest_rotation_hz(const drivers::SensorModel& model) {
  return *std::max_element(model.rotation_hz.begin(), model.rotation_hz.end());
}

ThreadSchedule schedule(const RealtimeSettings& realtime, const ThreadSchedule& asked) {
  return realtime.mode == RealtimeMode::off ? ThreadSchedule{} : asked;
}

std::vector<ThreadBudget> threads_of(const Configuration& configuration, double sweeps_per_s) {
  const RealtimeSettings& realtime = configuration.realtime;
  const auto row = [&realtime](std::string_view name, const ThreadSchedule& asked, double deadline_ms,
                               std::string_view task) {
    const ThreadSchedule has = schedule(realtime, asked);
    return ThreadBudget{name, has.priority, has.core, kRealtimeStack_bytes, deadline_ms, task};
  };
  return {row("rx", realtime.rx, kRxWakes_ms, "receives packets"),
          row("solve", realtime.solve, 1e3 / sweeps_per_s, "decodes, filters, matches"),
          row("tx", realtime.tx, 1e3 / configuration.can.rate_hz, "sends poses"),
          {"house", 0, -1, kOrdinaryStack_bytes, 0.0, "status, log, watchdog"},
          {"loader", 0, -1, kOrdinaryStack_bytes, 0.0, "loads map tiles"},
          {"searcher", 0, -1, kOrdinaryStack_bytes, 0.0, "looks for a vehicle that is lost"}};
}

std::uint64_t map_memory(const MapSettings& map, std::uint64_t map_bytes) {
  constexpr double kBytes_per_mib = 1 << 20;
  const auto allowed = static_cast<std::uint64_t>(map.memory_mib * kBytes_per_mib);
  return allowed == 0 ? map_bytes : std::min(allowed, map_bytes);
}

/// As VoxelGrid allocates it: for each centroid a block of eight cells, a table of the blocks by hash, and
/// their order.
std::uint64_t filter_bytes(std::size_t capacity) {
  constexpr std::size_t kCellSum = 16;
  constexpr std::size_t kKey = 8;
  constexpr std::size_t kSlot = 4;
  constexpr std::size_t kCorner = 16;
  constexpr std::size_t kCentroid = 12;
  constexpr std::size_t kOrder = 16;
  return capacity * (8 * kCellSum + kKey + kSlot + kCorner + kCentroid + 2 * kOrder) +
         std::bit_ceil(4 * capacity) * kSlot;
}

std::vector<MemoryBudget> memory_of(const Configuration& configuration, const drivers::SensorModel& model,
                                    std::uint64_t map_bytes, std::uint64_t search_bytes) {
  constexpr std::size_t kRealtimeThreads = 3;
  const std::uint64_t map = map_memory(configuration.map, map_bytes);
  return {
      {"map", map, map < map_bytes ? "two windows of it" : "all of it"},
      {"packet ring", packet_ring_slots(model) * largest_packet_bytes(model), "slots x largest packet"},
      {"points", 2 * Pipeline::kMaxPointsPerPacket * sizeof(drivers::Point), "of a packet, for two sweeps"},
      {"filter", filter_bytes(ndt::Matcher::kMaxPoints), "computed; \"entropy\" takes more"},
      {"matcher", ndt::Matcher({}).memory_bytes(), "of as many points as the filter gives"},
      {"place search", search_bytes, "the map from above, and lists"},
      {"histograms", kStageCount * sizeof(LatencyHistogram), "one a stage"},
      {"stacks", kRealtimeThreads * kRealtimeStack_bytes, "of the real-time threads"},
  };
}

std::vector<RateBudget> rates_of(const CanSettings& can, const drivers::SensorModel& model) {
  const double frames_per_s = can.rate_hz * static_cast<double>(can.fd ? 1 : kClassicPoseFrames);
  const double bits_per_s = frames_per_s * static_cast<double>(worst_frame_bits(can.fd));
  return {{"packets", packets_per_s(model), "1/s"},
          {"packet bytes", packets_per_s(model) * static_cast<double>(largest_packet_bytes(model)), "B/s"},
          {"sweeps", fastest_rotation_hz(model), "1/s"},
          {"poses", can.rate_hz, "1/s"},
          {"CAN frames", frames_per_s, "1/s"},
          {"bus load at 500 kbit/s", 100.0 * bits_per_s / kBus_bit_per_s, "%"}};
}

}  // namespace

std::uint64_t Budget::memory_bytes() const noexcept {
  return std::accumulate(memory.begin(), memory.end(), std::uint64_t{0},
                         [](std::uint64_t sum, const MemoryBudget& row) { return sum + row.bytes; });
}

Budget budget_of(const Configuration& configuration, const drivers::SensorModel& model,
                 std::uint64_t map_bytes, std::uint64_t search_bytes) {
  return {.threads = threads_of(configuration, fastest_rotation_hz(model)),
          .memory = memory_of(configuration, model, map_bytes, search_bytes),
          .rates = rates_of(configuration.can, model)};
}

std::size_t worst_frame_bits(bool fd) noexcept {
  constexpr std::size_t kGap = 3;
  constexpr std::size_t kEnd = 10;  // delimiters, acknowledgement, end of frame
  // Classic: 34 bits from the start to the CRC's end without data, and at worst one bit more after each four.
  constexpr std::size_t kClassic = 34 + 8 * kMaxClassicBytes;
  if (!fd) return kClassic + (kClassic - 1) / 4 + kEnd + kGap;
  // FD without a faster data phase: stuffed up to the data's end; then 4 bits of stuff count, 21 of CRC and 7
  // fixed ones.
  constexpr std::size_t kFd = 22 + 8 * kMaxFdBytes;
  return kFd + (kFd - 1) / 4 + 4 + 21 + 7 + kEnd + kGap;
}

}  // namespace landfix::platform
