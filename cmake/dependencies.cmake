# Everything comes from Debian; nothing is downloaded. packages.txt lists what to install.
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(fmt REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(CLI11 REQUIRED)
find_package(nanoflann REQUIRED)
find_package(embree 3 REQUIRED)
find_package(pugixml REQUIRED)
find_package(yaml-cpp REQUIRED)
find_package(PkgConfig REQUIRED)
pkg_check_modules(GEOGRAPHICLIB REQUIRED IMPORTED_TARGET geographiclib)
pkg_check_modules(HWY REQUIRED IMPORTED_TARGET libhwy)
pkg_check_modules(PCAP REQUIRED IMPORTED_TARGET libpcap)
pkg_check_modules(TOMLPLUSPLUS REQUIRED IMPORTED_TARGET tomlplusplus)

# Tells systemd that the service is ready and alive.
pkg_check_modules(SYSTEMD QUIET IMPORTED_TARGET libsystemd)
if(NOT SYSTEMD_FOUND)
  message(STATUS "Without libsystemd (libsystemd-dev): landfixd cannot be run as a service of Type=notify")
endif()

# Debian's liblzf ships neither a CMake file nor a pkg-config file.
find_path(LZF_INCLUDE_DIR liblzf/lzf.h REQUIRED)
find_library(LZF_LIBRARY lzf REQUIRED)
add_library(lzf INTERFACE IMPORTED)
target_include_directories(lzf INTERFACE "${LZF_INCLUDE_DIR}")
target_link_libraries(lzf INTERFACE "${LZF_LIBRARY}")

# What `landfix benchmark --rival pcl` measures landfix against; its NDT is in headers alone. A sanitizer could not
# look into the library.
if(NOT LANDFIX_SANITIZE)
  find_package(PCL 1.12 QUIET COMPONENTS common kdtree search filters)
endif()
if(NOT PCL_FOUND)
  message(STATUS "Without PCL (libpcl-dev): `landfix benchmark --rival pcl` and the benchmarks beside ours are left out")
endif()
