#include "tools/trace_writer.hpp"

#include <algorithm>
#include <string>

#include <fmt/format.h>

namespace landfix::tools {
namespace {

/// As trace viewers number them.
[[nodiscard]] int thread_of(std::size_t track) { return static_cast<int>(track) + 1; }

}  // namespace

TraceWriter::TraceWriter(const std::filesystem::path& path) : file_(path) {
  file_.write(R"({"displayTimeUnit":"ns","traceEvents":[)");
  add_event(R"("ph":"M","name":"process_name","args":{"name":"landfix"})");
  constexpr std::array<std::string_view, kTracks> kNames{"rx", "solve", "tx"};
  for (std::size_t i = 0; i < kTracks; ++i) {
    add_event(fmt::format(R"("ph":"M","name":"thread_name","tid":{},"args":{{"name":"{}"}})", thread_of(i),
                          kNames[i]));
    add_event(fmt::format(R"("ph":"M","name":"thread_sort_index","tid":{0},"args":{{"sort_index":{0}}})",
                          thread_of(i)));
  }
}

void TraceWriter::add(const platform::SolvedSweep& sweep) {
  const platform::SweepResult& result = sweep.result;
  const platform::SweepTimes& times = result.times;
  const bool came = !result.missing;
  if (begin_ns_ == 0) {
    begin_ns_ = came && times.first_packet_ns != 0 ? times.first_packet_ns : sweep.arrived_mono_ns;
    ended_ns_.fill(begin_ns_);
    counted_ns_ = begin_ns_;
  }
  if (came) {
    // The packet that ends a sweep may begin the next one too: add_span() begins that one where it ends.
    const std::int64_t arrived_ns = std::min(sweep.arrived_mono_ns, times.last_packet_ns);
    if (add_span(Track::receive, "packets", {times.first_packet_ns, arrived_ns})) {
      add_flow(Track::receive, 's', arrived_ns - 1, result.fix.at.stamp_utc_ns);
    }
    add_span(Track::solve, "last packet", {arrived_ns, times.last_packet_ns});
    add_span(Track::solve, "filter", {times.last_packet_ns, times.filtered_ns});
    const bool has_match =
        add_span(Track::solve, result.skipped ? "skip" : "match", {times.filtered_ns, times.matched_ns},
                 fmt::format(R"("state":"{}","iterations":{},"points":{},"out_of_time":{})",
                             ndt::to_string(result.fix.state), result.fix.match.iterations,
                             result.points_filtered, result.fix.match.out_of_time));
    if (has_match) add_flow(Track::solve, 't', times.matched_ns - 1, result.fix.at.stamp_utc_ns);
  }
  counted_ns_ = std::max(counted_ns_, came ? times.matched_ns : sweep.arrived_mono_ns);
  add_counter("state", counted_ns_, static_cast<double>(result.fix.state));
  if (!came) return;
  add_counter("iterations", counted_ns_, result.fix.match.iterations);
  add_counter("points", counted_ns_, static_cast<double>(result.points_filtered));
}

void TraceWriter::add(const platform::SentSweep& sent) {
  if (add_span(Track::send, "publish", {sent.began_mono_ns, sent.ended_mono_ns})) {
    add_flow(Track::send, 'f', sent.ended_mono_ns - 1, sent.stamp_utc_ns);
  }
}

void TraceWriter::commit() {
  file_.write("\n]}\n");
  file_.commit();
}

void TraceWriter::add_event(std::string_view event) {
  file_.write(fmt::format("{}\n{{\"pid\":1,{}}}", has_event_ ? "," : "", event));
  has_event_ = true;
}

/// What of it begins before the track's last span has ended is left out; whether there is anything left.
bool TraceWriter::add_span(Track track, std::string_view name, Span span, std::string_view arguments) {
  const auto index = static_cast<std::size_t>(track);
  const std::int64_t begin_ns = std::max(span.begin_ns, ended_ns_[index]);
  if (span.end_ns <= begin_ns) return false;
  ended_ns_[index] = span.end_ns;
  add_event(fmt::format(
      R"("ph":"X","tid":{},"name":"{}","cat":"sweep","ts":{:.3f},"dur":{:.3f},"args":{{{}}})",
      thread_of(index), name, us(begin_ns), 1e-3 * static_cast<double>(span.end_ns - begin_ns), arguments));
  return true;
}

/// Arrows join what has the same id: the sweep's stamp.
void TraceWriter::add_flow(Track track, char phase, std::int64_t at_ns, std::int64_t stamp_utc_ns) {
  add_event(fmt::format(R"("ph":"{}","tid":{},"name":"pose","cat":"pose","id":"{}","ts":{:.3f}{})", phase,
                        thread_of(static_cast<std::size_t>(track)), stamp_utc_ns, us(at_ns),
                        phase == 'f' ? R"(,"bp":"e")" : ""));
}

void TraceWriter::add_counter(std::string_view name, std::int64_t at_ns, double value) {
  add_event(
      fmt::format(R"("ph":"C","name":"{0}","ts":{1:.3f},"args":{{"{0}":{2:g}}})", name, us(at_ns), value));
}

}  // namespace landfix::tools
