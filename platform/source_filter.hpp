// What the kernel asks of every datagram to a port: is its source the sensor? (Classic BPF.)
#pragma once

#include <cstdint>

namespace landfix::platform {

/// IPv4, host byte order. They throw std::runtime_error where the kernel refuses.
///
/// From now on the socket receives from this address alone, or from every other alone.
void keep_only(int descriptor, std::uint32_t source_address);
void keep_all_but(int descriptor, std::uint32_t source_address);

/// For the first of two sockets that share a port (SO_REUSEPORT, both bound): what comes from the address
/// goes to the second, everything else to the first. Broadcasts and multicasts go to both all the same.
void divide_by_source(int descriptor, std::uint32_t source_address);

}  // namespace landfix::platform
