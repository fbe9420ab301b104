# SPDX-License-Identifier: Apache-2.0
# `cpack -G DEB` in the build folder: libkelpie-dev (the library and kelpie-logs), kelpie-tools,
# kelpie-live (the service of `kelpie live`), kelpie-doc; with KELPIE_WITH_MPI kelpie-mpi, and with
# KELPIE_BUILD_PYTHON python3-kelpie.
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

# For Debian alone: copyright and changelog beside every package, and a folder for zsh.
set(packages libkelpie-dev kelpie-tools kelpie-doc)
if(KELPIE_BUILD_LIVE)
  list(APPEND packages kelpie-live)
endif()
if(TARGET kelpie_mpi)
  list(APPEND packages kelpie-mpi)
endif()
if(TARGET kelpie_python AND NOT CMAKE_CROSSCOMPILING)
  list(APPEND packages python3-kelpie)
endif()
string(TIMESTAMP today "%a, %d %b %Y %H:%M:%S +0000" UTC)  # $SOURCE_DATE_EPOCH, where that is set
file(WRITE "${generated_dir}/changelog" "kelpie (${PROJECT_VERSION}) unstable; urgency=medium

  * CHANGELOG.md in the package kelpie-doc has the changes.

 -- ${CPACK_PACKAGE_CONTACT}  ${today}
")
find_program(GZIP gzip REQUIRED)
execute_process(COMMAND "${GZIP}" -9nf "${generated_dir}/changelog" COMMAND_ERROR_IS_FATAL ANY)
foreach(package IN LISTS packages)
  set(beside "${CMAKE_INSTALL_DATADIR}/doc/${package}")
  install(FILES cmake/debian_copyright DESTINATION "${beside}"
          RENAME copyright COMPONENT debian_${package} EXCLUDE_FROM_ALL)
  install(FILES "${generated_dir}/changelog.gz" DESTINATION "${beside}"
          COMPONENT debian_${package} EXCLUDE_FROM_ALL)
endforeach()
install(DIRECTORY docs examples DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/kelpie-doc"
        COMPONENT debian_kelpie-doc EXCLUDE_FROM_ALL
        PATTERN Doxyfile EXCLUDE PATTERN "*.dox" EXCLUDE PATTERN CMakeLists.txt EXCLUDE
        PATTERN __pycache__ EXCLUDE)
install(FILES README.md CHANGELOG.md DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/kelpie-doc"
        COMPONENT debian_kelpie-doc EXCLUDE_FROM_ALL)

set(CPACK_COMPONENTS_ALL development runtime debian_libkelpie-dev debian_kelpie-tools
    debian_kelpie-doc)
set(CPACK_COMPONENT_DEBIAN_KELPIE-DOC_GROUP kelpie_doc)
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
if("python3-kelpie" IN_LIST packages)
  set(python_folder lib/python3/dist-packages/kelpie)
  install(TARGETS kelpie_python LIBRARY DESTINATION "${python_folder}"
          COMPONENT debian_python3-kelpie EXCLUDE_FROM_ALL)
  install(DIRECTORY python/kelpie/ DESTINATION "${python_folder}"
          COMPONENT debian_python3-kelpie EXCLUDE_FROM_ALL PATTERN __pycache__ EXCLUDE)
  list(APPEND CPACK_COMPONENTS_ALL debian_python3-kelpie)
  set(CPACK_COMPONENT_DEBIAN_PYTHON3-KELPIE_GROUP python3_kelpie)
endif()
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(about "It learns accelerations of a vehicle from velocities and commands, one
sample at a time, in a fixed buffer and a bounded time per sample, and keeps
up when the vehicle changes.")

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

This package has the static libraries, headers, and the files for CMake and
pkg-config.")

set(CPACK_DEBIAN_KELPIE_TOOLS_PACKAGE_NAME kelpie-tools)
set(CPACK_DEBIAN_KELPIE_TOOLS_PACKAGE_SECTION science)
set(CPACK_DEBIAN_KELPIE_TOOLS_PACKAGE_SHLIBDEPS ON)
if(CMAKE_CROSSCOMPILING AND CMAKE_SYSTEM_PROCESSOR STREQUAL "aarch64")
  # dpkg knows only the packages of the machine it runs on. These are Debian 12's.
  set(CPACK_DEBIAN_PACKAGE_ARCHITECTURE arm64)
  set(CPACK_DEBIAN_KELPIE_TOOLS_PACKAGE_SHLIBDEPS OFF)
  string(CONCAT CPACK_DEBIAN_KELPIE_TOOLS_PACKAGE_DEPENDS
    "libbz2-1.0, libc6 (>= 2.36), libgcc-s1, libstdc++6 (>= 12), libfmt9, libhwy1, liblz4-1, "
    "libsqlite3-0, libssl3, libtinyxml2-9, libtomlplusplus3, libyaml-cpp0.7, libzip4, libzstd1, "
    "zlib1g")
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

This package has the command kelpie, which learns CSV logs and ROS 2 bags,
predicts, rolls models out, exports them as C, and simulates a vehicle.")
set(CPACK_DEBIAN_KELPIE_TOOLS_PACKAGE_SUGGESTS "kelpie-doc, python3-kelpie")

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

This package has what kelpie needs to do its studies on many machines, by
mpirun or srun.")

set(CPACK_DEBIAN_KELPIE_DOC_PACKAGE_NAME kelpie-doc)
set(CPACK_DEBIAN_KELPIE_DOC_PACKAGE_SECTION doc)
set(CPACK_DEBIAN_KELPIE_DOC_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_KELPIE_DOC_DESCRIPTION "${about}

This package has the documentation, and examples in C++, C, Python and as
configuration files of vehicles.")

set(CPACK_DEBIAN_PYTHON3_KELPIE_PACKAGE_NAME python3-kelpie)
set(CPACK_DEBIAN_PYTHON3_KELPIE_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON3_KELPIE_PACKAGE_SHLIBDEPS ON)
math(EXPR next_minor "${Python3_VERSION_MINOR} + 1")
string(CONCAT CPACK_DEBIAN_PYTHON3_KELPIE_PACKAGE_DEPENDS
  "python3 (>= 3.${Python3_VERSION_MINOR}~), python3 (<< 3.${next_minor}), python3-numpy")
set(CPACK_DEBIAN_PYTHON3_KELPIE_PACKAGE_RECOMMENDS "python3-pandas, python3-sklearn")
set(CPACK_DEBIAN_PYTHON3_KELPIE_PACKAGE_SUGGESTS "kelpie-doc, python3-matplotlib")
set(CPACK_DEBIAN_PYTHON3_KELPIE_DESCRIPTION "${about}

This package has the Python package kelpie: estimators with the contract of
scikit-learn, readers of logs, and the studies of the command kelpie.")

include(CPack)
