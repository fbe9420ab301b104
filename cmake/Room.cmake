# SPDX-License-Identifier: Apache-2.0

# kelpie_strict(TARGET): the warnings every target of ours is built with. GCC 12's -Wrestrict sees
# overlaps in std::string concatenation where there are none (GCC bug 105651).
function(kelpie_strict target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wconversion
    $<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,13>>:-Wno-restrict>
    $<$<BOOL:${KELPIE_WARNINGS_AS_ERRORS}>:-Werror>)
endfunction()

# kelpie_optimise(TARGET): the learners, and the opponents whose times are taken beside theirs, are
# optimised further than what is built around them.
function(kelpie_optimise target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O3>)
endfunction()

# kelpie_optimise_little(TARGET): what reads, writes and shows calls the learners for what takes time;
# optimising it further took a quarter of the time it compiles, and gained nothing.
function(kelpie_optimise_little target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
endfunction()

# kelpie_join_sources(TARGET): with KELPIE_JOIN_SOURCES, compiles all sources of a target at a time,
# since most of their time goes into headers of others and templates that they share. Every source
# still includes what it uses: the presets `debug` and `sanitize` build them one by one.
function(kelpie_join_sources target)
  if(KELPIE_JOIN_SOURCES)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 0)
    # In kB: a tenth of GCC's time went into tidying up its memory. The largest unit takes 1.1 GB.
    target_compile_options(${target} PRIVATE
      $<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=1000000>)
  endif()
endfunction()

# kelpie_join_rooms(TARGET "room room..." ...): the same for whole rooms, those of a list together:
# rooms that need the same headers of others, so that each is read as seldom as can be. What is
# private to a file of a room has a name of its own in the room.
function(kelpie_join_rooms target)
  kelpie_join_sources(${target})
  if(KELPIE_JOIN_SOURCES)
    set_target_properties(${target} PROPERTIES UNITY_BUILD_MODE GROUP)
    foreach(rooms IN LISTS ARGN)
      string(REPLACE " " "_" group "${rooms}")
      separate_arguments(rooms)
      foreach(room IN LISTS rooms)
        file(GLOB sources CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/src/${room}/*.cpp")
        set_source_files_properties(${sources} PROPERTIES UNITY_GROUP "${group}")
      endforeach()
    endforeach()
  endif()
endfunction()

# kelpie_library(NAME EXPORT name COMPONENT component ROOMS room...): a library of all sources in
# src/<room>/, which users link as kelpie::<EXPORT>; installed with its headers: those of the library
# are in include/kelpie/<room>/, a tool's stand beside its sources.
function(kelpie_library name)
  cmake_parse_arguments(arg "" "EXPORT;COMPONENT" "ROOMS" ${ARGN})
  set(sources)
  foreach(room IN LISTS arg_ROOMS)
    file(GLOB room_sources CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/src/${room}/*.cpp")
    list(APPEND sources ${room_sources})
  endforeach()
  set(headers "include")
  set(installed_headers "include")
  if(arg_COMPONENT STREQUAL "tools")
    set(headers "src")
    set(installed_headers "include/kelpie/tools")
  endif()
  add_library(${name} ${sources})
  add_library(kelpie::${arg_EXPORT} ALIAS ${name})
  set_target_properties(${name} PROPERTIES
    EXPORT_NAME ${arg_EXPORT}
    VERSION ${PROJECT_VERSION}
    SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  target_include_directories(${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/${headers}>
    $<INSTALL_INTERFACE:${installed_headers}>)
  target_compile_features(${name} PUBLIC cxx_std_20)
  # The Python module is a shared object; in there, hidden symbols are as quick as in a program.
  set_target_properties(${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  if(NOT BUILD_SHARED_LIBS)
    set_target_properties(${name} PROPERTIES
      CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
  endif()
  kelpie_strict(${name})
  if(KELPIE_INSTALL)
    install(TARGETS ${name} EXPORT kelpie_${arg_COMPONENT} COMPONENT development)
    foreach(room IN LISTS arg_ROOMS)
      if(arg_COMPONENT STREQUAL "tools")
        install(DIRECTORY "${PROJECT_SOURCE_DIR}/src/${room}" COMPONENT development
                DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/kelpie/tools"
                FILES_MATCHING PATTERN "*.hpp")
      elseif(EXISTS "${PROJECT_SOURCE_DIR}/include/kelpie/${room}")  # else a private room
        install(DIRECTORY "${PROJECT_SOURCE_DIR}/include/kelpie/${room}" COMPONENT development
                DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/kelpie")
      endif()
    endforeach()
  endif()
endfunction()
