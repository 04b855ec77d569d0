// Which instruction sets the SIMD parts are compiled for. Left out: what is next to another and gains nothing
// but compile time, and vectors whose length is unknown to the compiler.
#pragma once

#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)

#include <hwy/targets.h>  // which heeds it
