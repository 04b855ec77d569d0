// A capture as sweeps: its sensor found out, its unit's calibration read from wherever it is.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "drivers/any_decoder.hpp"
#include "drivers/decoder.hpp"
#include "drivers/sensor_model.hpp"
#include "drivers/sweep.hpp"
#include "platform/pcap_source.hpp"
#include "tools/capture_census.hpp"
#include "tools/decode_report.hpp"

namespace landfix::tools {

struct CaptureInput {
  std::string sensor;       ///< empty: the only one that the capture can hold
  std::string calibration;  ///< file; empty: the capture's own, or the model's
  std::string pcap;
  drivers::DecoderOptions options{};
};

/// Warns on stderr of what it has to do without.
class DecodedCapture {
 public:
  /// Throws UsageError where the sensor is not clear, std::runtime_error where the capture holds none of its
  /// packets or a file cannot be read.
  explicit DecodedCapture(CaptureInput input);

  [[nodiscard]] const drivers::SensorModel& model() const noexcept { return model_; }
  [[nodiscard]] double percent_read() const noexcept { return source_.percent_read(); }

  /// All sweeps, in order, the last one as far as it goes. Throws std::runtime_error where no packet could be
  /// decoded.
  DecodeSummary read(const std::function<void(const drivers::Sweep&)>& on_sweep);

 private:
  CaptureInput input_;
  platform::PcapSource source_;
  CaptureCensus census_;
  const drivers::SensorModel& model_;
  std::uint16_t port_;
  drivers::AnyDecoder decoder_;
  std::vector<drivers::Point> storage_;
  drivers::SweepPair sweeps_;
};

}  // namespace landfix::tools
