# SPDX-License-Identifier: Apache-2.0
# `cpack -G DEB` in the build folder: libkelpie-dev (the library and kelpie-logs), kelpie-tools,
# kelpie-live (the service of `kelpie live`) and, with KELPIE_WITH_MPI, kelpie-mpi.
if(BUILD_SHARED_LIBS)
  return()  # these packages are of static libraries
endif()

set(CPACK_PACKAGE_NAME kelpie)
set(CPACK_PACKAGE_VENDOR "The kelpie developers")
set(CPACK_PACKAGE_CONTACT "The kelpie developers <developers@kelpie.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_RESOURCE_FILE_LICENSE "${PROJECT_SOURCE_DIR}/LICENSE")
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_GENERATOR DEB)

# For Debian alone: the copyright beside every package, and a folder for zsh.
set(packages libkelpie-dev kelpie-tools)
if(KELPIE_BUILD_LIVE)
  list(APPEND packages kelpie-live)
endif()
if(TARGET kelpie_mpi)
  list(APPEND packages kelpie-mpi)
endif()
foreach(package IN LISTS packages)
  install(FILES cmake/debian_copyright DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/${package}"
          RENAME copyright COMPONENT debian_${package} EXCLUDE_FROM_ALL)
endforeach()

set(CPACK_COMPONENTS_ALL development runtime debian_libkelpie-dev debian_kelpie-tools)
set(CPACK_COMPONENT_DEVELOPMENT_GROUP libkelpie_dev)
set(CPACK_COMPONENT_DEBIAN_LIBKELPIE-DEV_GROUP libkelpie_dev)
set(CPACK_COMPONENT_RUNTIME_GROUP kelpie_tools)
set(CPACK_COMPONENT_DEBIAN_KELPIE-TOOLS_GROUP kelpie_tools)
if(KELPIE_BUILD_LIVE)
  list(APPEND CPACK_COMPONENTS_ALL service debian_kelpie-live)
  set(CPACK_COMPONENT_SERVICE_GROUP kelpie_live)
  set(CPACK_COMPONENT_DEBIAN_KELPIE-LIVE_GROUP kelpie_live)
endif()
if(TARGET kelpie_mpi)
  list(APPEND CPACK_COMPONENTS_ALL mpi debian_kelpie-mpi)
  set(CPACK_COMPONENT_MPI_GROUP kelpie_mpi)
  set(CPACK_COMPONENT_DEBIAN_KELPIE-MPI_GROUP kelpie_mpi)
endif()
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(about "It learns accelerations of a vehicle from velocities and commands, one sample at a time,
in a fixed buffer and a bounded time per sample, and keeps up when the vehicle changes.")

set(CPACK_DEBIAN_LIBKELPIE_DEV_PACKAGE_NAME libkelpie-dev)
set(CPACK_DEBIAN_LIBKELPIE_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_LIBKELPIE_DEV_PACKAGE_DEPENDS "libhwy-dev (>= 1.0)")
# Programs that link kelpie::logs need these as well.
string(CONCAT CPACK_DEBIAN_LIBKELPIE_DEV_PACKAGE_RECOMMENDS
  "pkg-config, libbz2-dev, libeigen3-dev (>= 3.4), libfmt-dev, liblz4-dev, libsqlite3-dev, "
  "libtomlplusplus-dev, libyaml-cpp-dev, libzstd-dev, zlib1g-dev")
if(MATIO_FOUND)
  string(APPEND CPACK_DEBIAN_LIBKELPIE_DEV_PACKAGE_RECOMMENDS ", libmatio-dev")
endif()
set(CPACK_DEBIAN_LIBKELPIE_DEV_DESCRIPTION "${about}

This package has the static libraries, headers, and the files for CMake and pkg-config.")

set(CPACK_DEBIAN_KELPIE_TOOLS_PACKAGE_NAME kelpie-tools)
set(CPACK_DEBIAN_KELPIE_TOOLS_PACKAGE_SECTION science)
set(CPACK_DEBIAN_KELPIE_TOOLS_PACKAGE_SHLIBDEPS ON)
if(CMAKE_CROSSCOMPILING AND CMAKE_SYSTEM_PROCESSOR STREQUAL "aarch64")
  # dpkg knows only the packages of the machine it runs on. These are Debian 12's.
  set(CPACK_DEBIAN_PACKAGE_ARCHITECTURE arm64)
  set(CPACK_DEBIAN_KELPIE_TOOLS_PACKAGE_SHLIBDEPS OFF)
  string(CONCAT CPACK_DEBIAN_KELPIE_TOOLS_PACKAGE_DEPENDS
    "libbz2-1.0, libc6 (>= 2.36), libgcc-s1, libstdc++6 (>= 12), libfmt9, libhwy1, liblz4-1, "
    "libsqlite3-0, libssl3, libtomlplusplus3, libyaml-cpp0.7, libzstd1, zlib1g")
  if(CYCLONEDDS_FOUND)
    string(APPEND CPACK_DEBIAN_KELPIE_TOOLS_PACKAGE_DEPENDS ", libddsc0debian")
  endif()
  if(MATIO_FOUND)
    string(APPEND CPACK_DEBIAN_KELPIE_TOOLS_PACKAGE_DEPENDS ", libmatio11")
  endif()
  if(SYSTEMD_FOUND)
    string(APPEND CPACK_DEBIAN_KELPIE_TOOLS_PACKAGE_DEPENDS ", libsystemd0")
  endif()
  if(MICROHTTPD_FOUND)
    string(APPEND CPACK_DEBIAN_KELPIE_TOOLS_PACKAGE_DEPENDS ", libmicrohttpd12")
  endif()
endif()
set(CPACK_DEBIAN_KELPIE_TOOLS_DESCRIPTION "${about}

This package has the command kelpie, which learns CSV logs and ROS 2 bags, predicts, rolls models
out, exports them as C, and simulates a vehicle.")

set(CPACK_DEBIAN_KELPIE_LIVE_PACKAGE_NAME kelpie-live)
set(CPACK_DEBIAN_KELPIE_LIVE_PACKAGE_SECTION science)
set(CPACK_DEBIAN_KELPIE_LIVE_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_KELPIE_LIVE_PACKAGE_DEPENDS "kelpie-tools (= ${PROJECT_VERSION})")
set(CPACK_DEBIAN_KELPIE_LIVE_DESCRIPTION "${about}

This package runs `kelpie live` as a service of systemd, one per vehicle.")

set(CPACK_DEBIAN_KELPIE_MPI_PACKAGE_NAME kelpie-mpi)
set(CPACK_DEBIAN_KELPIE_MPI_PACKAGE_SECTION science)
set(CPACK_DEBIAN_KELPIE_MPI_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_KELPIE_MPI_PACKAGE_DEPENDS "kelpie-tools (= ${PROJECT_VERSION}), openmpi-bin")
set(CPACK_DEBIAN_KELPIE_MPI_DESCRIPTION "${about}

This package has what kelpie needs to do its studies on many machines, by mpirun or srun.")

include(CPack)
