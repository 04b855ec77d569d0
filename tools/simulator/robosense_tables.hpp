// Where the lasers of three units point, in the order of the slots, and when they fire.
#pragma once

#include <array>
#include <cstddef>

namespace landfix::tools::simulator::robosense {

/// Units of the device information: 0.001 deg (RS-LiDAR-32), 0.0001 (RS-LiDAR-16), 0.01 (Helios).
struct Angles {
  int vertical;
  int horizontal;  ///< clockwise
};

/// The nominal angles in the order that the manual's examples and most units have, each laser off by a little
/// and all columns by +0.41 deg, as units are.
inline constexpr std::array<Angles, 32> kRs32Angles{
    {{-10274, 8391}, {-6431, 8425},  {2341, 8402},   {3329, -7612},  {4680, 8433},    {6992, -7571},
     {10351, 8388},  {15022, -7604}, {337, -7555},   {6, -2270},     {-341, 3104},    {-672, 8420},
     {1659, -7618},  {1338, -2249},  {1011, 3071},   {655, 8377},    {-25043, -7630}, {-14661, -7543},
     {-7902, -7589}, {-5418, -7601}, {-3659, -7577}, {-4012, -2281}, {-4327, 3092},   {-4678, 8446},
     {-2341, -7566}, {-2655, -2238}, {-3008, 3066},  {-3322, 8399},  {-1009, -7594},  {-1326, -2260},
     {-1674, 3081},  {-1991, 8411}}};
/// -15 to -1, then 15 to 1: the sign of the first half is known, not sent.
inline constexpr std::array<Angles, 16> kRs16Angles{{{-150300, 0},
                                                     {-130120, 0},
                                                     {-109850, 0},
                                                     {-90210, 0},
                                                     {-69930, 0},
                                                     {-50080, 0},
                                                     {-30150, 0},
                                                     {-9910, 0},
                                                     {149860, 0},
                                                     {130240, 0},
                                                     {110070, 0},
                                                     {89900, 0},
                                                     {70190, 0},
                                                     {49950, 0},
                                                     {29840, 0},
                                                     {10110, 0}}};
/// Downwards, in two columns, as a recorded Helios has them.
inline constexpr std::array<Angles, 16> kHelios16pAngles{{{1494, -405},
                                                          {1303, 361},
                                                          {1102, -400},
                                                          {898, 358},
                                                          {704, -397},
                                                          {496, 356},
                                                          {303, -396},
                                                          {99, 355},
                                                          {-98, -395},
                                                          {-305, 355},
                                                          {-497, -395},
                                                          {-702, 355},
                                                          {-896, -396},
                                                          {-1103, 356},
                                                          {-1298, -397},
                                                          {-1505, 357}}};

/// Nanoseconds since the block's azimuth. Lasers 16 and 32 fire one step late.
inline constexpr std::array<int, 32> kRs32Firing_ns{0,     2880,  5760,  8640,  11520, 14400, 17280, 20160,
                                                    23040, 25920, 28800, 31680, 34560, 37440, 40320, 44640,
                                                    1440,  4320,  7200,  10080, 12960, 15840, 18720, 21600,
                                                    24480, 27360, 30240, 33120, 36000, 38880, 41760, 46080};
inline constexpr std::array<int, 16> kRs16Firing_ns{0,     2800,  5600,  8400,  11200, 14000, 16800, 19600,
                                                    22400, 25200, 28000, 30800, 33600, 36400, 39200, 42000};
inline constexpr std::array<int, 16> kHelios16pFiring_ns{
    0, 3150, 6300, 9450, 13260, 17080, 20560, 23710, 26530, 27770, 31490, 32730, 36460, 38940, 41420, 43910};

}  // namespace landfix::tools::simulator::robosense
