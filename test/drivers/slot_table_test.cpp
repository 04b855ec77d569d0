// The vectorised loops against the plainest way to the same points, bit for bit.
#include "drivers/slot_table.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/centidegrees.hpp"

namespace landfix::drivers {
namespace {

class SlotTableTest : public testing::Test {
 protected:
  SlotTableTest() {
    std::uniform_real_distribution<float> metres(-0.05F, 0.05F);
    std::uniform_real_distribution<float> unit(-1.0F, 1.0F);
    for (std::size_t i = 0; i < kMaxSlots; ++i) {
      table_.origin_x_m[i] = metres(random_);
      table_.origin_y_m[i] = metres(random_);
      table_.origin_z_m[i] = metres(random_);
      table_.direction_x[i] = unit(random_);
      table_.direction_y[i] = unit(random_);
      table_.direction_z[i] = unit(random_);
      table_.square_m2[i] = -std::abs(metres(random_)) * 0.05F;
      table_.lead_m[i] = metres(random_);
      table_.time_s[i] = 50e-6F * std::abs(unit(random_));
      table_.ring[i] = static_cast<std::uint32_t>(kMaxSlots - i);
    }
  }

  /// Half of the others' ranges are equal, one in eight is none.
  void draw_slots() {
    std::uniform_int_distribution<int> any_byte(0, 255);
    for (std::size_t i = 0; i < slots_.size(); ++i) {
      slots_[i] = static_cast<std::byte>(any_byte(random_));
      others_[i] = any_byte(random_) < 128 ? slots_[i] : static_cast<std::byte>(any_byte(random_));
    }
    for (std::size_t i = 0; i < kMaxSlots; i += 8) slots_[3 * i] = slots_[3 * i + 1] = std::byte{0};
  }

  [[nodiscard]] std::uint16_t range_at(const std::byte* slots, std::size_t i) const {
    const bool little = table_.byte_order == ByteOrder::little;
    const auto low = std::to_integer<unsigned>(slots[3 * i + (little ? 0 : 1)]);
    const auto high = std::to_integer<unsigned>(slots[3 * i + (little ? 1 : 0)]);
    return static_cast<std::uint16_t>(low + 256 * high);
  }

  [[nodiscard]] std::vector<Point> plainly(const SlotBlock& block, RawBounds bounds) const {
    std::vector<Point> points;
    for (std::size_t i = 0; i < table_.count; ++i) {
      const std::uint16_t range_raw = range_at(block.slots, i);
      if (block.duplicates != nullptr && range_at(block.duplicates, i) == range_raw) continue;
      if (range_raw < bounds.least || range_raw > bounds.most) continue;
      const float range_m = static_cast<float>(range_raw) * block.unit_m;
      const float along_m =
          std::sqrt(std::max(range_m * range_m + table_.square_m2[i], 0.0F)) - table_.lead_m[i];
      const float x = table_.origin_x_m[i] + along_m * table_.direction_x[i];
      const float y = table_.origin_y_m[i] + along_m * table_.direction_y[i];
      points.push_back({.x = x * block.cosine + y * block.sine,
                        .y = y * block.cosine - x * block.sine,
                        .z = table_.origin_z_m[i] + along_m * table_.direction_z[i],
                        .intensity = static_cast<float>(std::to_integer<int>(block.slots[3 * i + 2])),
                        .time_s = block.time_s + table_.time_s[i],
                        .ring = static_cast<std::uint16_t>(table_.ring[i])});
    }
    return points;
  }

  std::mt19937 random_{5};
  SlotTable table_;
  std::vector<std::byte> slots_ = std::vector<std::byte>(3 * kMaxSlots);
  std::vector<std::byte> others_ = std::vector<std::byte>(3 * kMaxSlots);
};

TEST_F(SlotTableTest, GivesTheSamePointsToTheBitForEveryNumberOfSlots) {
  for (std::size_t count = 0; count <= kMaxSlots; ++count) {
    for (const ByteOrder order : {ByteOrder::little, ByteOrder::big}) {
      for (const bool dual : {false, true}) {
        draw_slots();
        table_.count = count;
        table_.byte_order = order;
        // Blocks of memory of their own: a sanitizer sees what is read or written beyond them.
        const std::vector<std::byte> slots(slots_.begin(),
                                           slots_.begin() + 3 * static_cast<std::ptrdiff_t>(count));
        const std::vector<std::byte> others(others_.begin(),
                                            others_.begin() + 3 * static_cast<std::ptrdiff_t>(count));
        const SlotBlock block{.slots = slots.data(),
                              .duplicates = dual ? others.data() : nullptr,
                              .sine = 0.6F,
                              .cosine = 0.8F,
                              .time_s = 0.0123F,
                              .unit_m = 0.004F};
        const RawBounds bounds{.least = 75, .most = 50000};
        const auto expected = plainly(block, bounds);
        std::vector<Point> points(count);
        const SlotPoints written = project_slots(table_, block, bounds, points);
        ASSERT_EQ(written.count, expected.size()) << count;
        float latest_s = 0.0F;
        for (std::size_t i = 0; i < expected.size(); ++i) {
          latest_s = std::max(latest_s, expected[i].time_s);
          ASSERT_EQ(std::memcmp(&points[i], &expected[i], offsetof(Point, ring) + 2), 0)
              << count << ", " << i;
        }
        EXPECT_EQ(written.latest_s, latest_s);
      }
    }
  }
}

TEST(SineCosine, IsThatOfTheLibraryForEveryAzimuth) {
  for (unsigned centideg = 0; centideg < 36000; ++centideg) {
    const SineCosine found = sine_cosine(static_cast<std::uint16_t>(centideg));
    const double angle_rad = centideg * (std::numbers::pi / 18000.0);
    EXPECT_NEAR(found.sine, std::sin(angle_rad), 2e-15);
    EXPECT_NEAR(found.cosine, std::cos(angle_rad), 2e-15);
    if (centideg % 9000 == 0) continue;  // of which pi is not quite a quarter
    ASSERT_EQ(static_cast<float>(found.sine), static_cast<float>(std::sin(angle_rad))) << centideg;
    ASSERT_EQ(static_cast<float>(found.cosine), static_cast<float>(std::cos(angle_rad))) << centideg;
  }
}

}  // namespace
}  // namespace landfix::drivers
