# SPDX-License-Identifier: Apache-2.0
# What each building needs from others, found once for the whole tree.

# The library
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(nlohmann_json 3.11 REQUIRED)
find_package(PkgConfig REQUIRED)
pkg_check_modules(HWY IMPORTED_TARGET libhwy>=1.0)
if(NOT HWY_FOUND)
  message(FATAL_ERROR "kelpie needs Highway 1.0 or newer, with its file for pkg-config (Debian 12, "
                      "Ubuntu 24.04: libhwy-dev)")
endif()

# kelpie_optional(PREFIX OPTION MODULE "without it"): a module of pkg-config that OPTION asks for.
macro(kelpie_optional prefix option module without)
  set(${prefix}_FOUND FALSE)  # the cache may hold the result of a run with the option on
  if(${option})
    pkg_check_modules(${prefix} IMPORTED_TARGET ${module} ${ARGN})
    if(NOT ${prefix}_FOUND)
      message(STATUS "kelpie: ${without}")
    endif()
  endif()
endmacro()

if(KELPIE_BUILD_LOGS)
  find_package(fmt REQUIRED)
  find_package(tomlplusplus REQUIRED)
  find_package(yaml-cpp REQUIRED)
  find_package(SQLite3 REQUIRED)
  find_package(ZLIB REQUIRED)
  find_package(BZip2 REQUIRED)
  pkg_check_modules(ZSTD REQUIRED IMPORTED_TARGET libzstd)
  pkg_check_modules(LZ4 REQUIRED IMPORTED_TARGET liblz4)
  kelpie_optional(MATIO KELPIE_WITH_MATLAB matio>=1.5.20
    "files of MATLAB are not read, because libmatio is missing (Debian 12: libmatio-dev)")
endif()

if(KELPIE_BUILD_TOOLS)
  find_package(CLI11 REQUIRED)
  find_package(Threads REQUIRED)
  find_package(tinyxml2 REQUIRED)
  pkg_check_modules(ZIP REQUIRED IMPORTED_TARGET libzip)
endif()

if(KELPIE_BUILD_LIVE)
  pkg_check_modules(CRYPTO REQUIRED IMPORTED_TARGET libcrypto)
  kelpie_optional(CYCLONEDDS KELPIE_WITH_DDS CycloneDDS>=0.10
    "no topics of ROS 2, because Cyclone DDS 0.10 is missing (Debian 12: cyclonedds-dev)"
    CycloneDDS<0.11)
  kelpie_optional(MICROHTTPD KELPIE_WITH_WEB libmicrohttpd>=0.9.75
    "`kelpie live` has no page, because libmicrohttpd is missing (Debian 12: libmicrohttpd-dev)")
  # The notes of a service to systemd
  kelpie_optional(SYSTEMD KELPIE_BUILD_LIVE libsystemd
    "`kelpie live` sends systemd no notes, because libsystemd is missing (Debian 12: libsystemd-dev)")
endif()
