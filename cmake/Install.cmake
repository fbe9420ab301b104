# SPDX-License-Identifier: Apache-2.0
# What `cmake --install` puts where, and how others find it. Components: development (libraries,
# headers, files for CMake and pkg-config) and runtime (the command, its manual and completions,
# its service, scenarios and vehicles); mpi (its plug-in for many machines, where it is built); lab
# (kelpie-lab, where it is built; in no Debian package).
include(CMakePackageConfigHelpers)

set(package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/kelpie")
set(generated_dir "${PROJECT_BINARY_DIR}/install")

configure_package_config_file("${CMAKE_CURRENT_LIST_DIR}/kelpieConfig.cmake.in"
  "${generated_dir}/kelpieConfig.cmake" INSTALL_DESTINATION "${package_dir}")
write_basic_package_version_file("${generated_dir}/kelpieConfigVersion.cmake"
  COMPATIBILITY SameMinorVersion)
install(FILES "${generated_dir}/kelpieConfig.cmake" "${generated_dir}/kelpieConfigVersion.cmake"
        DESTINATION "${package_dir}" COMPONENT development)
install(EXPORT kelpie_library NAMESPACE kelpie:: FILE kelpieLibrary.cmake
        DESTINATION "${package_dir}" COMPONENT development)

file(RELATIVE_PATH PC_UP "${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig" "${CMAKE_INSTALL_PREFIX}")
configure_file("${CMAKE_CURRENT_LIST_DIR}/kelpie.pc.in" "${generated_dir}/kelpie.pc" @ONLY)
install(FILES "${generated_dir}/kelpie.pc" DESTINATION "${CMAKE_INSTALL_LIBDIR}/pkgconfig"
        COMPONENT development)
install(FILES include/kelpie/kelpie.h DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/kelpie"
        COMPONENT development)
install(FILES package.xml DESTINATION "${CMAKE_INSTALL_DATADIR}/kelpie" COMPONENT development)

if(KELPIE_BUILD_TOOLS)
  # A shared library lies in a folder of its own beside bin/.
  file(RELATIVE_PATH from_bin_to_lib "${CMAKE_INSTALL_FULL_BINDIR}" "${CMAKE_INSTALL_FULL_LIBDIR}")
  set_target_properties(kelpie_cli PROPERTIES INSTALL_RPATH
    "$<$<BOOL:${BUILD_SHARED_LIBS}>:\$ORIGIN/${from_bin_to_lib}>")
  install(EXPORT kelpie_tools NAMESPACE kelpie:: FILE kelpieTools.cmake
          DESTINATION "${package_dir}" COMPONENT development)
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
  if(TARGET kelpie_mpi)
    install(TARGETS kelpie_mpi COMPONENT mpi LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}/kelpie")
    install(PROGRAMS scripts/slurm/kelpie-study.sbatch COMPONENT mpi
            DESTINATION "${CMAKE_INSTALL_DATADIR}/kelpie/slurm")
  endif()
  # Of no use without systemd, and no harm.
  install(FILES "${CMAKE_CURRENT_LIST_DIR}/kelpie-live@.service" DESTINATION lib/systemd/system
          COMPONENT runtime)
  include("${CMAKE_CURRENT_LIST_DIR}/Documents.cmake")
endif()

if(KELPIE_BUILD_TOOLS AND PROJECT_IS_TOP_LEVEL)
  include(cmake/Package.cmake)
endif()
