#include "platform/frame_description.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <span>
#include <string_view>

#include <fmt/format.h>

#include "platform/pose_frame_table.hpp"

namespace landfix::platform {
namespace {

constexpr int kDefaultPeriod_ms = 100;  // of poses, CanSettings::rate_hz
constexpr int kStandardFd = 14;         // of the attribute VFrameFormat
constexpr std::string_view kSender = "LANDFIX";

/// Of the end-to-end protection; its name is the frame's and this.
struct HeaderSignal {
  std::string_view suffix;
  Bits bits;
  std::string_view meaning;
};

constexpr std::array kHeader11c{
    HeaderSignal{"_CRC", unsigned_at(0, 8), "CRC of AUTOSAR E2E profile 11C"},
    HeaderSignal{"_CTR", unsigned_at(8, 4), "counter of AUTOSAR E2E profile 11C, 0 to 14"},
    HeaderSignal{"_ID", unsigned_at(12, 4), "bits 8 to 11 of the data id"},
};
constexpr std::array kHeader05{
    HeaderSignal{"_CRC", unsigned_at(0, 16), "CRC of AUTOSAR E2E profile 5"},
    HeaderSignal{"_CTR", unsigned_at(16, 8), "counter of AUTOSAR E2E profile 5"},
};

std::span<const HeaderSignal> header_of(const FrameLayout& layout) {
  return layout.fd ? std::span<const HeaderSignal>(kHeader05) : std::span<const HeaderSignal>(kHeader11c);
}

std::string_view profile_name(const FrameLayout& layout) { return layout.fd ? "5" : "11C"; }

/// A bus begins without values; a code has no such value and begins with 0.
std::string start_value(const Signal& signal) {
  if (signal.is_code()) return "0";
  return fmt::format("{}{}", signal.bits.is_signed ? "-" : "", signal.not_available());
}

/// Without an exponent: not every reader of DBC files takes one.
std::string decimal(double value) {
  std::array<char, 64> text;
  char* const end =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed).ptr;
  return {text.data(), end};
}

/// What so many steps are, with the decimals of one, as far as they tell anything.
std::string physical(const Signal& signal, double steps) {
  if (steps == 0.0) return "0";
  const std::string step = decimal(signal.scale);
  const std::size_t point = step.find('.');
  constexpr std::size_t kMostDecimals = 12;
  return fmt::format("{:.{}f}", steps * signal.scale,
                     point == std::string::npos ? 0 : std::min(step.size() - point - 1, kMostDecimals));
}

/// "s24 0.001 m"; of a code, "u4".
std::string format_of(const Signal& signal) {
  std::string format = fmt::format("{}{}", signal.bits.is_signed ? 's' : 'u', signal.bits.length);
  if (signal.scale != 1.0) format += fmt::format(" {}", decimal(signal.scale));
  if (!signal.unit.empty()) format += fmt::format(" {}", signal.unit);
  return format;
}

void add_message(std::string& dbc, const FrameLayout& layout, std::uint32_t id) {
  dbc += fmt::format("BO_ {} {}: {} {}\n", id, layout.name, layout.length(), kSender);
  for (const HeaderSignal& signal : header_of(layout)) {
    dbc += fmt::format(" SG_ {}{} : {}|{}@1+ (1,0) [0|{}] \"\" Vector__XXX\n", layout.name, signal.suffix,
                       signal.bits.start, signal.bits.length, signal.bits.mask());
  }
  for (const Signal& signal : layout.signals) {
    dbc += fmt::format(" SG_ {} : {}|{}@1{} ({},0) [{}|{}] \"{}\" Vector__XXX\n", signal.name,
                       signal.bits.start, signal.bits.length, signal.bits.is_signed ? '-' : '+',
                       decimal(signal.scale), physical(signal, static_cast<double>(signal.lowest())),
                       physical(signal, static_cast<double>(signal.highest())), signal.unit);
  }
  dbc += "\n";
}

void add_comments(std::string& dbc, const FrameLayout& layout, std::uint32_t id) {
  dbc += fmt::format("CM_ BO_ {} \"{}; AUTOSAR E2E profile {}, data id 0x{:X}\";\n", id, layout.meaning,
                     profile_name(layout), layout.data_id());
  for (const HeaderSignal& signal : header_of(layout)) {
    dbc += fmt::format("CM_ SG_ {} {}{} \"{}\";\n", id, layout.name, signal.suffix, signal.meaning);
  }
  for (const Signal& signal : layout.signals) {
    dbc += fmt::format("CM_ SG_ {} {} \"{}{}\";\n", id, signal.name, signal.meaning,
                       signal.is_code() ? "" : fmt::format("; raw {}: not available", start_value(signal)));
  }
}

void add_attributes(std::string& dbc, const FrameLayout& layout, std::uint32_t id) {
  dbc += fmt::format("BA_ \"GenMsgCycleTime\" BO_ {} {};\n", id,
                     layout.period_ms != 0 ? int{layout.period_ms} : kDefaultPeriod_ms);
  if (layout.fd) dbc += fmt::format("BA_ \"VFrameFormat\" BO_ {} {};\n", id, kStandardFd);
  for (const Signal& signal : layout.signals) {
    if (!signal.is_code()) {
      dbc += fmt::format("BA_ \"GenSigStartValue\" SG_ {} {} {};\n", id, signal.name, start_value(signal));
    }
  }
}

void add_names(std::string& dbc, const FrameLayout& layout, std::uint32_t id) {
  for (const Signal& signal : layout.signals) {
    if (signal.names.empty()) continue;
    dbc += fmt::format("VAL_ {} {}", id, signal.name);
    for (std::size_t i = 0; i < signal.names.size(); ++i)
      dbc += fmt::format(" {} \"{}\"", i, signal.names[i]);
    dbc += " ;\n";
  }
}

}  // namespace

std::string to_dbc(std::uint32_t base_id) {
  std::string dbc = fmt::format("VERSION \"{}\"\n\nNS_ :\n\nBS_:\n\nBU_: {}\n\n", kFramesVersion, kSender);
  const auto for_each_frame = [&](const auto& add_part) {
    for (const FrameLayout& layout : kFrameLayouts) add_part(dbc, layout, base_id + layout.id_offset);
  };
  for_each_frame(add_message);
  dbc += "CM_ \"landfix: where the vehicle is. Written by: landfix can dbc\";\n";
  for_each_frame(add_comments);
  dbc +=
      "BA_DEF_ \"BusType\" STRING ;\n"
      "BA_DEF_ BO_ \"GenMsgCycleTime\" INT 0 65535;\n"
      "BA_DEF_ BO_ \"GenMsgSendType\" ENUM \"Cyclic\";\n"
      "BA_DEF_ BO_ \"VFrameFormat\" ENUM \"StandardCAN\",\"ExtendedCAN\"";
  for (int i = 2; i < kStandardFd; ++i) dbc += ",\"reserved\"";
  dbc +=
      ",\"StandardCAN_FD\",\"ExtendedCAN_FD\";\n"
      "BA_DEF_ SG_ \"GenSigStartValue\" FLOAT -9223372036854775808 18446744073709551615;\n"
      "BA_DEF_DEF_ \"BusType\" \"CAN FD\";\n"
      "BA_DEF_DEF_ \"GenMsgCycleTime\" 0;\n"
      "BA_DEF_DEF_ \"GenMsgSendType\" \"Cyclic\";\n"
      "BA_DEF_DEF_ \"VFrameFormat\" \"StandardCAN\";\n"
      "BA_DEF_DEF_ \"GenSigStartValue\" 0;\n"
      "BA_ \"BusType\" \"CAN FD\";\n";
  for_each_frame(add_attributes);
  for_each_frame(add_names);
  return dbc;
}

std::string to_markdown() {
  std::string table = "| id | frame | protection | signals: bits, step |\n|---|---|---|---|\n";
  for (const FrameLayout& layout : kFrameLayouts) {
    table += fmt::format("| +{} | `{}`, {}{} | {}, id 0x{:X} |", layout.id_offset, layout.name,
                         layout.fd ? "CAN FD, 64 bytes, " : "",
                         layout.period_ms != 0 ? fmt::format("every {} ms", layout.period_ms) : "every pose",
                         profile_name(layout), layout.data_id());
    for (std::size_t i = 0; i < layout.signals.size(); ++i) {
      const bool is_last = i + 1 == layout.signals.size();
      const std::string format = format_of(layout.signals[i]);
      table += fmt::format(" `{}`", layout.signals[i].name);
      // Neighbours of one format share its mention.
      if (is_last)
        table += fmt::format(" {} |\n", format);
      else if (format_of(layout.signals[i + 1]) == format)
        table += ",";
      else
        table += fmt::format(" {};", format);
    }
  }
  return table;
}

}  // namespace landfix::platform
