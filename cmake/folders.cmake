# One floor of the house a folder: landfix_library(NAME FOLDER drivers [HOT] SOURCES ... DEPENDS ...)
#
# A target sees its own folder and, through DEPENDS, those below. Each folder has an include root that
# holds nothing but a link to it, so that an include that points up the stack finds no file.
# HOT marks what runs after start-up: no exceptions, no RTTI, and its symbols are checked by a test.

add_library(landfix_options INTERFACE)
target_compile_options(landfix_options INTERFACE
  -Wall -Wextra -Wpedantic -Wconversion -Wsign-conversion -Wshadow -Wdouble-promotion -Wvla
  -Wnon-virtual-dtor -Woverloaded-virtual -Werror
  -Wno-psabi) # only ever says that gcc 4.5 passed aligned values another way
if(LANDFIX_SANITIZE)
  target_compile_options(landfix_options INTERFACE
    -fsanitize=${LANDFIX_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer
    $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>) # gcc 12 sees phantoms in the standard library's instrumented code
  target_link_options(landfix_options INTERFACE -fsanitize=${LANDFIX_SANITIZE})
  if(LANDFIX_SANITIZE MATCHES undefined AND CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    target_compile_options(landfix_options INTERFACE
      -fsanitize-ignorelist=${CMAKE_CURRENT_LIST_DIR}/undefined_behaviour_ignored.txt)
  endif()
endif()

# Of what is not hot, the time to compile counts, most of all where sanitizers swell the code.
set(landfix_cold_options -O1)
if(LANDFIX_SANITIZE)
  set(landfix_cold_options -O0)
endif()

if(LANDFIX_FUZZERS)
  # Coverage that guides the fuzzers; the main function is linked by test/fuzz alone.
  target_compile_options(landfix_options INTERFACE -fsanitize=fuzzer-no-link)
endif()

define_property(GLOBAL PROPERTY LANDFIX_HOT_TARGETS BRIEF_DOCS "Libraries of the hot path")

function(landfix_library NAME)
  cmake_parse_arguments(ARG "HOT" "FOLDER" "SOURCES;DEPENDS" ${ARGN})
  add_library(${NAME} STATIC ${ARG_SOURCES})
  set(root "${CMAKE_BINARY_DIR}/include/${ARG_FOLDER}")
  file(MAKE_DIRECTORY "${root}")
  file(CREATE_LINK "${CMAKE_SOURCE_DIR}/${ARG_FOLDER}" "${root}/${ARG_FOLDER}" SYMBOLIC)
  target_include_directories(${NAME} PUBLIC "${root}")
  target_link_libraries(${NAME} PUBLIC ${ARG_DEPENDS} PRIVATE landfix_options)
  if(NOT CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    # Arm fuses a multiplication and an addition wherever the compiler sees them, x86-64 cannot before AVX2: without
    # it, points and maps are the same to the bit on both. Where fusing pays, the code asks for it.
    target_compile_options(${NAME} PRIVATE -ffp-contract=off)
  endif()
  set_target_properties(${NAME} PROPERTIES LANDFIX_FOLDER ${ARG_FOLDER})
  set_property(GLOBAL APPEND PROPERTY LANDFIX_LIBRARIES ${NAME})
  if(ARG_HOT)
    target_compile_options(${NAME} PRIVATE -fno-exceptions -fno-rtti)
    if(NOT LANDFIX_SANITIZE)  # whose red zones swell the frames
      target_compile_options(${NAME} PRIVATE -Wframe-larger-than=16384)
    endif()
    set_property(GLOBAL APPEND PROPERTY LANDFIX_HOT_TARGETS ${NAME})
  endif()
endfunction()
