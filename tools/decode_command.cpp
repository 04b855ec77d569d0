// landfix decode: a capture to point clouds, one file a sweep.
#include <map>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "tools/command.hpp"
#include "tools/decode_report.hpp"
#include "tools/decoded_capture.hpp"
#include "tools/landfix_commands.hpp"
#include "tools/sweep_files.hpp"

namespace landfix::tools {
namespace {

struct DecodeArguments {
  CaptureInput capture;
  std::string output;
  SweepFormat format = SweepFormat::pcd;
  bool json = false;
};

void decode(const DecodeArguments& arguments) {
  DecodedCapture capture(arguments.capture);
  SweepFiles files(arguments.output, arguments.format);
  std::size_t sweeps = 0;
  const DecodeSummary summary = capture.read([&](const drivers::Sweep& sweep) {
    files.write(sweep);
    show_progress(fmt::format("{:3.0f} %, {} sweeps", capture.percent_read(), ++sweeps));
  });
  if (const std::size_t older = files.left_over(); older != 0) {
    fmt::print(stderr, "{} also holds {} sweeps of an earlier run, behind the last of this one\n",
               arguments.output, older);
  }
  arguments.json ? print_json(capture.model(), summary)
                 : print_text(capture.model(), summary, arguments.output);
}

}  // namespace

void add_decode_command(CLI::App& app) {
  const std::map<std::string, SweepFormat> formats{{"pcd", SweepFormat::pcd}, {"csv", SweepFormat::csv}};
  const auto arguments = std::make_shared<DecodeArguments>();
  CLI::App& command = *app.add_subcommand("decode", "point clouds from a capture, one file a sweep");
  command
      .add_option("--sensor", arguments->capture.sensor,
                  "its name (landfix sensors); found out where not given")
      ->type_name("NAME");
  command
      .add_option("--calibration", arguments->capture.calibration,
                  "the unit's own file (see landfix sensors)")
      ->type_name("FILE");
  command.add_option("--pcap", arguments->capture.pcap, "capture, pcap or pcapng")
      ->required()
      ->type_name("FILE");
  command.add_option("--output", arguments->output, "folder for 0000.pcd and on")
      ->required()
      ->type_name("DIR");
  command.add_option("--format", arguments->format, "of the files")
      ->transform(one_of(formats))
      ->type_name("pcd|csv")
      ->default_str("pcd");
  command
      .add_option(
          "--cut-deg", arguments->capture.options.cut_deg,
          "azimuth at which a sweep begins, clockwise from the front; Ouster's begin where its frames do")
      ->check(in_range(-360.0, 360.0))
      ->type_name("D")
      ->capture_default_str();
  add_json_option(command, arguments->json);
  command.callback([arguments] { decode(*arguments); });
}

}  // namespace landfix::tools
