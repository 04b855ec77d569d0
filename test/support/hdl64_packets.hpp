// Data packets of the HDL-64E, sound and empty, for tests and benchmarks.
#pragma once

#include "support/synthetic_packets.hpp"

namespace landfix::test {

/// Upper and lower blocks in turn. `returns`: blocks of a pair with one azimuth; two only for the S3.
inline VelodynePacket hdl64_packet(unsigned first_centideg, unsigned step_centideg, std::size_t returns = 1) {
  VelodynePacket packet(0, 'V');
  for (std::size_t block = 1; block < drivers::velodyne::kBlocks; block += 2) packet.set_flag(block, 0xDDFF);
  packet.set_azimuths(first_centideg, step_centideg, 2 * returns);
  return packet;
}

/// The S1's: one lower block, three upper ones, each with its azimuth.
inline VelodynePacket hdl64s1_packet(unsigned first_centideg, unsigned step_centideg) {
  VelodynePacket packet('C', 'g');
  for (std::size_t block = 0; block < drivers::velodyne::kBlocks; block += 4) packet.set_flag(block, 0xDDFF);
  packet.set_azimuths(first_centideg, step_centideg);
  return packet;
}

}  // namespace landfix::test
