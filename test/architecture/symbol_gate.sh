#!/bin/sh
# symbol_gate.sh NM LIBRARY...
# Passes if no library calls what the hot path must not: the heap, exceptions, RTTI, locks, threads, the C and
# C++ streams. An undefined symbol is a call that would be linked in.
set -eu
nm=$1
shift
[ $# -gt 0 ] || {
  echo 'no library to look at'
  exit 1
}

heap='(malloc|calloc|realloc|free|reallocarray|aligned_alloc|posix_memalign|memalign|strdup)$|operator (new|delete)'
exceptions='__cxa_(allocate_exception|throw|rethrow|begin_catch|bad_cast|bad_typeid)|__dynamic_cast|__gxx_personality|_Unwind_|std::__throw_'
locks='__cxa_guard_|pthread_|sem_(wait|post)|mtx_|cnd_|std::(mutex|condition_variable|thread|__atomic_wait|this_thread)|syscall$'
streams='(f|s|sn|vf|vs|vsn|d)?printf$|__[a-z]*printf_chk$|puts$|fputs$|fputc$|putchar$|f(open|close|read|write|flush)$|std::(ios_base|basic_ostream|basic_istream|cout|cerr)'

status=0
for library in "$@"; do
  listing=$("$nm" --undefined-only --demangle "$library")
  calls=$(printf '%s\n' "$listing" | awk '/:$/ { object = $0 } sub(/^ *[Uwv] /, "") { print object, $0 }')
  if found=$(printf '%s\n' "$calls" | grep -E "^[^ ]* ($heap|$exceptions|$locks|$streams)"); then
    printf '%s calls what the hot path must not:\n%s\n' "$(basename "$library")" "$found"
    status=1
  fi
done
exit $status
