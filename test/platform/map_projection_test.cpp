#include "platform/map_projection.hpp"

#include <cmath>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "platform/heap_counter.hpp"
#include "platform/map_projector_info.hpp"
#include "platform/map_reference.hpp"
#include "platform/pose_frame_table.hpp"
#include "support/error_of.hpp"
#include "support/test_data.hpp"

namespace landfix::platform {
namespace {

const std::string kOrigin = "map_origin: {latitude: 49.0, longitude: 8.4, altitude: 110.0}\n";

MapReference parse(const std::string& text) { return parse_map_projector_info(text, "info.yaml"); }

struct Golden {
  const char* name;
  std::string text;
  Eigen::Vector3d position_m;
  GeodeticPosition expected;
  std::uint16_t utm_zone;
};

// From GeographicLib's programs GeoConvert, CartConvert and TransverseMercatorProj, and again from Krueger's
// series and the geocentric formulas written anew in Python; they agree in every digit.
const Golden kGolden[] = {
    {"MGRS north",
     "projector_type: MGRS\nvertical_datum: WGS84\nmgrs_grid: 54SUE\n",
     {80000, 50000, 12},
     {35.68660948381, 139.67382014173, 12.0},
     54},
    {"MGRS south",
     "projector_type: MGRS\nmgrs_grid: 33HUC\n",
     {34900.5, 52300.25, -3},
     {-33.85669634561, 13.21530140392, -3.0},
     33},
    {"UTM",
     "projector_type: LocalCartesianUTM\n" + kOrigin,
     {1200, -3400, 25},
     {48.96950055653, 8.41676249214, 135.0},
     32},
    {"plane",
     "projector_type: LocalCartesian\n" + kOrigin,
     {1200, -3400, 25},
     {48.96942654279, 8.41638938412, 136.019765},
     0},
    {"Mercator",
     "projector_type: TransverseMercator\n" + kOrigin,
     {1200, -3400, 25},
     {48.96941365707, 8.41639628707, 135.0},
     0},
    {"Mercator of scale 1",
     "projector_type: TransverseMercator\nscale_factor: 1.0\n" + kOrigin,
     {1200, -3400, 25},
     {48.96942589210, 8.41638973257, 135.0},
     0},
};

TEST(MapProjection, IsThatOfIndependentCalculations) {
  for (const Golden& golden : kGolden) {
    const MapReference reference = parse(golden.text);
    ASSERT_TRUE(reference.projection) << golden.name;
    const GeodeticPosition position = to_geodetic(*reference.projection, golden.position_m);
    EXPECT_NEAR(position.latitude_deg, golden.expected.latitude_deg, 1e-10) << golden.name;
    EXPECT_NEAR(position.longitude_deg, golden.expected.longitude_deg, 1e-10) << golden.name;
    EXPECT_NEAR(position.altitude_m, golden.expected.altitude_m, 1e-6) << golden.name;
    EXPECT_EQ(reference.utm_zone, golden.utm_zone) << golden.name;
    EXPECT_EQ(reference.datum, 1) << golden.name;
  }
}

TEST(MapProjection, LeadsThereAndBack) {
  for (const Golden& golden : kGolden) {
    const MapReference reference = parse(golden.text);
    const MapPlace place = to_map(*reference.projection, golden.expected);
    EXPECT_LT((place.position_m - golden.position_m).norm(), 2e-5) << golden.name;
    // A step of 100 m in the direction that is said to be north changes the latitude alone.
    const Eigen::Vector3d north_m(std::cos(place.north_rad), std::sin(place.north_rad), 0.0);
    const GeodeticPosition to = to_geodetic(*reference.projection, golden.position_m + 100.0 * north_m);
    EXPECT_GT(to.latitude_deg, golden.expected.latitude_deg + 0.0008) << golden.name;
    EXPECT_NEAR(to.longitude_deg, golden.expected.longitude_deg, 1e-8) << golden.name;
  }
}

TEST(MapProjection, DoesNotTouchTheHeap) {
  if (!HeapCounter::available()) GTEST_SKIP() << "the heap is not counted here";
  for (const Golden& golden : kGolden) {
    const MapReference reference = parse(golden.text);
    PoseReport report;
    report.x_m = 100.0;
    report.y_m = 200.0;
    report.z_m = 3.0;
    const std::uint64_t before = HeapCounter::calls();
    HeapCounter::arm();
    for (int i = 0; i < 1000; ++i) reference.add_to(report);
    HeapCounter::disarm();
    EXPECT_EQ(HeapCounter::calls(), before) << golden.name;
    EXPECT_FALSE(std::isnan(report.latitude_deg)) << golden.name;
  }
}

TEST(MapReference, TellsLatitudeAndLongitudeWhereThereIsAPosition) {
  MapReference reference = parse(kGolden[0].text);
  reference.hash = 0xBEEF;
  PoseReport report;
  reference.add_to(report);
  EXPECT_TRUE(std::isnan(report.latitude_deg));
  EXPECT_TRUE(std::isnan(report.longitude_deg));
  EXPECT_EQ(report.map_hash, 0xBEEF);
  EXPECT_EQ(pose_frame_table::kProjectors[report.map_projector], "MGRS");
  EXPECT_EQ(pose_frame_table::kDatums[report.map_datum], "WGS84");
  EXPECT_EQ(report.frames_version, kFramesVersion);
}

TEST(MapReference, PositionsAreRelativeToTheOriginThatIsNearest) {
  MapReference reference = parse(kGolden[0].text);
  const Eigen::Vector3d position_m(81000.0, 49999.0, 12.0);
  reference.origin = map_origin_near(position_m);
  EXPECT_EQ(reference.origin, 10 + 16 * 6);
  PoseReport report;
  report.x_m = 80000.0;
  report.y_m = 50000.0;
  report.z_m = 12.0;
  reference.add_to(report);
  EXPECT_EQ(report.x_m, 0.0);
  EXPECT_EQ(report.y_m, 2000.0);
  EXPECT_EQ(report.z_m, 12.0);
  EXPECT_EQ(report.map_origin, 106);
  EXPECT_NEAR(report.latitude_deg, 35.68660948381, 1e-10);
}

TEST(MapReference, TheOriginsReachAroundASquareOf100km) {
  EXPECT_EQ(map_origin_near({3999.0, -500.0, 0.0}), 0);
  EXPECT_EQ(map_origin_near({-1e6, 1e6, 0.0}), 15 << 4);
  for (double x_m = 0.0; x_m <= 100e3; x_m += 499.0) {
    const Eigen::Vector3d position_m(x_m, 100e3 - x_m, 0.0);
    const Eigen::Vector3d relative_m = position_m - map_origin_m(map_origin_near(position_m));
    EXPECT_LE(relative_m.cwiseAbs().maxCoeff(), 4000.0);
  }
}

TEST(MapProjectorInfo, OfALocalMapHasNoProjection) {
  const MapReference reference = parse("projector_type: Local\n");
  EXPECT_FALSE(reference.projection);
  EXPECT_EQ(pose_frame_table::kProjectors[reference.projector], "LOCAL");
  EXPECT_EQ(pose_frame_table::kDatums[reference.datum], "UNKNOWN");
}

TEST(MapProjectorInfo, TheNamesAreThoseOfTheFrames) {
  EXPECT_EQ(pose_frame_table::kProjectors[parse(kGolden[2].text).projector], "LOCAL_CARTESIAN_UTM");
  EXPECT_EQ(pose_frame_table::kProjectors[parse(kGolden[3].text).projector], "LOCAL_CARTESIAN");
  EXPECT_EQ(pose_frame_table::kProjectors[parse(kGolden[4].text).projector], "TRANSVERSE_MERCATOR");
  EXPECT_EQ(
      pose_frame_table::kDatums[parse("projector_type: MGRS\nvertical_datum: EGM2008\nmgrs_grid: 54SUE\n")
                                    .datum],
      "EGM2008");
}

TEST(MapProjectorInfo, SaysWhatIsWrongAndWhere) {
  const auto error_of = [](const std::string& text) { return test::error_of([&] { (void)parse(text); }); };
  EXPECT_EQ(error_of("projector_type: local\n"),
            "info.yaml:1:17: projector_type is none of Local, MGRS, LocalCartesianUTM, LocalCartesian, "
            "TransverseMercator");
  EXPECT_EQ(error_of("vertical_datum: WGS84\n"),
            "info.yaml: projector_type is missing: one of Local, MGRS, LocalCartesianUTM, LocalCartesian, "
            "TransverseMercator");
  EXPECT_EQ(error_of("projector_type: MGRS\n"), "info.yaml: mgrs_grid, such as 54SUE, is missing");
  EXPECT_EQ(error_of("projector_type: MGRS\nvertical_datum: NN\nmgrs_grid: 54SUE\n"),
            "info.yaml:2:17: vertical_datum is none of WGS84, EGM2008");
  for (const char* grid : {"54SUE12", "54S", "ZAH", "99XYZ", "''", "[54SUE]"}) {
    EXPECT_NE(error_of("projector_type: MGRS\nmgrs_grid: " + std::string(grid) + "\n").find("mgrs_grid"),
              std::string::npos)
        << grid;
  }
  EXPECT_EQ(error_of("projector_type: LocalCartesian\n"),
            "info.yaml:1:1: map_origin with latitude and longitude is missing");
  EXPECT_EQ(error_of("projector_type: LocalCartesian\nmap_origin: {latitude: 49}\n"),
            "info.yaml:2:13: map_origin has no longitude");
  EXPECT_EQ(error_of("projector_type: LocalCartesian\nmap_origin: {latitude: 91, longitude: 8}\n"),
            "info.yaml:2:24: latitude is no number from -90 to 90");
  EXPECT_EQ(error_of("projector_type: LocalCartesian\nvertical_datum: EGM2008\n" + kOrigin),
            "info.yaml:2:17: LocalCartesian needs heights above WGS84");
  EXPECT_EQ(error_of("projector_type: TransverseMercator\nscale_factor: 0\n" + kOrigin),
            "info.yaml:2:15: scale_factor is no number from 0.5 to 2");
  EXPECT_EQ(error_of("projector_type: LocalCartesianUTM\nmap_origin: {latitude: 89, longitude: 8}\n"),
            "info.yaml:2:13: map_origin is in a polar region, which has no UTM");
  EXPECT_NE(error_of("projector_type: [\n").find("info.yaml:2:1: "), std::string::npos);
  EXPECT_EQ(error_of(""), "info.yaml: expected projector_type and what belongs to it");
}

TEST(MapProjectorInfo, IsReadFromAFile) {
  const test::TemporaryDirectory directory;
  const auto path = directory.path() / "map_projector_info.yaml";
  std::ofstream(path) << kGolden[0].text;
  EXPECT_EQ(read_map_projector_info(path).utm_zone, 54);
  EXPECT_THROW((void)read_map_projector_info(directory.path() / "none.yaml"), std::runtime_error);
}

}  // namespace
}  // namespace landfix::platform
