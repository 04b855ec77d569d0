#include "drivers/ouster/crc64.hpp"

#include <array>

#include "drivers/little_endian.hpp"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace landfix::drivers::ouster {
namespace {

constexpr std::uint64_t kPolynomial = 0xC96C'5795'D787'0F42;  // reflected: bit 63 is the power 0
constexpr std::uint64_t kOnes = ~std::uint64_t{0};

constexpr std::uint64_t times_x(std::uint64_t value) noexcept {
  return (value >> 1) ^ ((value & 1U) != 0 ? kPolynomial : 0);
}

using Table = std::array<std::uint64_t, 256>;

/// [k][b]: what byte b contributes when k more bytes follow it.
constexpr std::array<Table, 8> make_tables() noexcept {
  std::array<Table, 8> tables{};
  for (std::size_t b = 0; b < 256; ++b) {
    std::uint64_t value = b;
    for (int bit = 0; bit < 8; ++bit) value = times_x(value);
    tables[0][b] = value;
  }
  for (std::size_t k = 1; k < 8; ++k) {
    for (std::size_t b = 0; b < 256; ++b) {
      const std::uint64_t before = tables[k - 1][b];
      tables[k][b] = (before >> 8) ^ tables[0][before & 0xFF];
    }
  }
  return tables;
}
constexpr std::array<Table, 8> kTables = make_tables();

/// Eight bytes at a time.
std::uint64_t advance(std::uint64_t crc, std::span<const std::byte> bytes) noexcept {
  for (; bytes.size() >= 8; bytes = bytes.subspan(8)) {
    crc ^= load_little_endian<std::uint64_t>(bytes.data());
    std::uint64_t next = 0;
    for (std::size_t k = 0; k < 8; ++k) next ^= kTables[7 - k][(crc >> (8 * k)) & 0xFF];
    crc = next;
  }
  for (const std::byte byte : bytes) {
    crc = (crc >> 8) ^ kTables[0][(crc ^ std::to_integer<std::uint64_t>(byte)) & 0xFF];
  }
  return crc;
}

#if defined(__x86_64__)

/// x to the power of n, modulo the polynomial.
constexpr std::uint64_t power_of_x(unsigned n) noexcept {
  std::uint64_t value = std::uint64_t{1} << 63;
  for (unsigned i = 0; i < n; ++i) value = times_x(value);
  return value;
}

// Folding (Gopal et al., "Fast CRC Computation for Generic Polynomials Using PCLMULQDQ Instruction", 2009):
// 128 bits H x^64 + L that are D bits before the place where they are added are the same as
// H (x^(D+64) mod P) + L (x^D mod P). The product of two reflected words comes out times x, hence the - 1.
template <unsigned Distance>
constexpr std::array<std::uint64_t, 2> kFold{power_of_x(Distance + 63), power_of_x(Distance - 1)};

constexpr std::size_t kBlockBytes = 16;
constexpr std::size_t kLanes = 4;

__attribute__((target("sse2"))) inline __m128i load(const std::byte* bytes) noexcept {
  return _mm_loadu_si128(reinterpret_cast<const __m128i*>(bytes));
}

__attribute__((target("sse2,pclmul"))) inline __m128i fold(__m128i value, __m128i by, __m128i onto) noexcept {
  const __m128i high = _mm_clmulepi64_si128(value, by, 0x00);
  const __m128i low = _mm_clmulepi64_si128(value, by, 0x11);
  return _mm_xor_si128(onto, _mm_xor_si128(high, low));
}

template <unsigned Distance>
__attribute__((target("sse2"))) inline __m128i fold_factors() noexcept {
  return _mm_set_epi64x(static_cast<long long>(kFold<Distance>[1]),
                        static_cast<long long>(kFold<Distance>[0]));
}

/// At least kLanes blocks.
__attribute__((target("sse2,pclmul"))) std::uint64_t crc64_by_folding(
    std::span<const std::byte> bytes) noexcept {
  const std::byte* at = bytes.data();
  std::size_t blocks = bytes.size() / kBlockBytes;
  __m128i a = _mm_xor_si128(load(at), _mm_set_epi64x(0, static_cast<long long>(kOnes)));
  __m128i b = load(at + kBlockBytes);
  __m128i c = load(at + 2 * kBlockBytes);
  __m128i d = load(at + 3 * kBlockBytes);
  const __m128i far = fold_factors<128 * kLanes>();
  for (blocks -= kLanes, at += kLanes * kBlockBytes; blocks >= kLanes;
       blocks -= kLanes, at += kLanes * kBlockBytes) {
    a = fold(a, far, load(at));
    b = fold(b, far, load(at + kBlockBytes));
    c = fold(c, far, load(at + 2 * kBlockBytes));
    d = fold(d, far, load(at + 3 * kBlockBytes));
  }
  const __m128i near = fold_factors<128>();
  const __m128i folded = fold(fold(fold(a, near, b), near, c), near, d);
  std::array<std::byte, kBlockBytes> last;
  _mm_storeu_si128(reinterpret_cast<__m128i*>(last.data()), folded);
  const auto rest = bytes.subspan(static_cast<std::size_t>(at - bytes.data()));
  return advance(advance(0, last), rest) ^ kOnes;
}

#endif

}  // namespace

std::uint64_t crc64_by_tables(std::span<const std::byte> bytes) noexcept {
  return advance(kOnes, bytes) ^ kOnes;
}

std::uint64_t crc64(std::span<const std::byte> bytes) noexcept {
#if defined(__x86_64__)
  if (bytes.size() >= kLanes * kBlockBytes && __builtin_cpu_supports("pclmul"))
    return crc64_by_folding(bytes);
#endif
  return crc64_by_tables(bytes);
}

}  // namespace landfix::drivers::ouster
