// Marks a function to be compiled for several instruction sets, of which the widest that the processor has is
// chosen when the program is loaded (LANDFIX_CLONES comes from drivers/CMakeLists.txt). None that fuse a
// multiplication and an addition: they would round otherwise.
#pragma once

#ifdef LANDFIX_CLONES
#define LANDFIX_WIDEST __attribute__((target_clones("avx2", "default")))
#else
#define LANDFIX_WIDEST
#endif
