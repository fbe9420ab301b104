# SPDX-License-Identifier: Apache-2.0
# Where `cmake --install` puts files, and how other projects find them. Components: development (the
# libraries kelpie and kelpie-logs, headers, files for CMake and pkg-config), runtime (the command,
# manual, completions, scenarios, vehicles), service (the service of `kelpie live`), lab
# (kelpie-lab; in no Debian package), and, for Debian alone, python.
include(CMakePackageConfigHelpers)

set(package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/kelpie")
set(generated_dir "${PROJECT_BINARY_DIR}/install")

configure_package_config_file("${CMAKE_CURRENT_LIST_DIR}/kelpieConfig.cmake.in"
  "${generated_dir}/kelpieConfig.cmake" INSTALL_DESTINATION "${package_dir}")
write_basic_package_version_file("${generated_dir}/kelpieConfigVersion.cmake"
  COMPATIBILITY SameMajorVersion)
install(FILES "${generated_dir}/kelpieConfig.cmake" "${generated_dir}/kelpieConfigVersion.cmake"
        DESTINATION "${package_dir}" COMPONENT development)
install(EXPORT kelpie NAMESPACE kelpie:: FILE kelpieLibrary.cmake
        DESTINATION "${package_dir}" COMPONENT development)
if(KELPIE_BUILD_LOGS)
  install(EXPORT kelpie_logs NAMESPACE kelpie:: FILE kelpieLogs.cmake
          DESTINATION "${package_dir}" COMPONENT development)
endif()

file(RELATIVE_PATH PC_UP "${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig" "${CMAKE_INSTALL_PREFIX}")
configure_file("${CMAKE_CURRENT_LIST_DIR}/kelpie.pc.in" "${generated_dir}/kelpie.pc" @ONLY)
install(FILES "${generated_dir}/kelpie.pc" DESTINATION "${CMAKE_INSTALL_LIBDIR}/pkgconfig"
        COMPONENT development)
install(FILES package.xml DESTINATION "${CMAKE_INSTALL_DATADIR}/kelpie" COMPONENT development)

if(KELPIE_BUILD_TOOLS)
  # A shared library lies in a folder of its own beside bin/.
  file(RELATIVE_PATH from_bin_to_lib "${CMAKE_INSTALL_FULL_BINDIR}" "${CMAKE_INSTALL_FULL_LIBDIR}")
  set_target_properties(kelpie_cli PROPERTIES INSTALL_RPATH
    "$<$<BOOL:${BUILD_SHARED_LIBS}>:\$ORIGIN/${from_bin_to_lib}>")
  install(TARGETS kelpie_cli COMPONENT runtime)
  install(DIRECTORY scenarios vehicles DESTINATION "${CMAKE_INSTALL_DATADIR}/kelpie"
          COMPONENT runtime)
  if(KELPIE_BUILD_LAB)
    set_target_properties(kelpie_lab PROPERTIES INSTALL_RPATH
      "$<$<BOOL:${BUILD_SHARED_LIBS}>:\$ORIGIN/${from_bin_to_lib}>")
    install(TARGETS kelpie_lab COMPONENT lab)
  endif()
  install(PROGRAMS scripts/slurm/kelpie-study-array.sbatch COMPONENT runtime
          DESTINATION "${CMAKE_INSTALL_DATADIR}/kelpie/slurm")
  install(TARGETS kelpie_fmu COMPONENT runtime LIBRARY
          DESTINATION "${CMAKE_INSTALL_LIBDIR}/kelpie")
  if(KELPIE_BUILD_LIVE)  # harmless without systemd
    install(FILES "${CMAKE_CURRENT_LIST_DIR}/kelpie-live@.service" DESTINATION lib/systemd/system
            COMPONENT service)
  endif()
  include("${CMAKE_CURRENT_LIST_DIR}/Documents.cmake")
endif()

if(KELPIE_BUILD_PYTHON)  # where Debian's Python looks; elsewhere pip installs the package
  set(python_folder lib/python3/dist-packages/kelpie)
  install(TARGETS kelpie_python LIBRARY DESTINATION "${python_folder}"
          COMPONENT python EXCLUDE_FROM_ALL)
  install(DIRECTORY python/kelpie/ DESTINATION "${python_folder}"
          COMPONENT python EXCLUDE_FROM_ALL PATTERN __pycache__ EXCLUDE)
endif()
