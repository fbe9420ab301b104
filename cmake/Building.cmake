# SPDX-License-Identifier: Apache-2.0
# A building is a folder of rooms with a CMakeLists.txt and a README.md of its own: src/library,
# src/logs, src/tools, src/live and lab. The functions below make its targets.

# kelpie_strict(TARGET): the warnings of every target. GCC 12's -Wrestrict reports overlaps in
# std::string concatenation where none exist (GCC bug 105651).
function(kelpie_strict target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wconversion
    $<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,13>>:-Wno-restrict>
    $<$<BOOL:${KELPIE_WARNINGS_AS_ERRORS}>:-Werror>)
endfunction()

# kelpie_optimise(TARGET LEVEL): the release build's level. The learners, and the opponents measured
# beside the learners, have 3; code around them has 1, which saves a quarter of the compile time and
# costs no measurable run time.
function(kelpie_optimise target level)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O${level}>)
endfunction()

# kelpie_join_sources(TARGET [SOURCES]): with KELPIE_JOIN_SOURCES, compiles all sources of a target as
# one unit, or as units of so many sources, because most compile time goes into headers that the
# sources share; a unit takes at most 1 GB of memory. Every source still includes what it uses: the
# preset `debug` compiles the sources one by one.
function(kelpie_join_sources target)
  if(KELPIE_JOIN_SOURCES)
    set(most 0)
    if(ARGC GREATER 1)
      set(most ${ARGV1})
    endif()
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${most})
  endif()
endfunction()

# kelpie_join_rooms(TARGET "room room..." ...): the same for rooms of the current building; the
# rooms of one list, which need the same foreign headers, form one unit. A source of a later list, by
# name (room/part*), leaves the unit of an earlier one.
function(kelpie_join_rooms target)
  kelpie_join_sources(${target})
  if(KELPIE_JOIN_SOURCES)
    set_target_properties(${target} PROPERTIES UNITY_BUILD_MODE GROUP)
    foreach(rooms IN LISTS ARGN)
      string(MAKE_C_IDENTIFIER "${rooms}" group)
      separate_arguments(rooms)
      foreach(room IN LISTS rooms)
        if(NOT room MATCHES "/")
          string(APPEND room "/*")
        endif()
        file(GLOB sources CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/${room}.cpp")
        set_source_files_properties(${sources} PROPERTIES UNITY_GROUP "${group}")
      endforeach()
    endforeach()
  endif()
endfunction()

# kelpie_library(TARGET [PRIVATE|OBJECT] ROOMS room...): a library of all sources in the rooms of the
# current building, which other targets of the tree include by room ("log/csv.hpp"). PRIVATE: not
# installed, and always static. OBJECT: rooms of another library, with options of their own.
function(kelpie_library name)
  cmake_parse_arguments(arg "PRIVATE;OBJECT" "" "ROOMS" ${ARGN})
  set(sources)
  foreach(room IN LISTS arg_ROOMS)
    file(GLOB room_sources CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/${room}/*.cpp")
    list(APPEND sources ${room_sources})
  endforeach()
  set(kind)
  if(arg_PRIVATE)
    set(kind STATIC)
  elseif(arg_OBJECT)
    set(kind OBJECT)
  endif()
  add_library(${name} ${kind} ${sources})
  set_target_properties(${name} PROPERTIES
    VERSION ${PROJECT_VERSION}
    SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  target_include_directories(${name} PUBLIC $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}>)
  target_compile_features(${name} PUBLIC cxx_std_20)
  # The Python module is a shared object, in which hidden symbols are as fast as in a program.
  set_target_properties(${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  if(NOT BUILD_SHARED_LIBS)
    set_target_properties(${name} PROPERTIES
      CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
  endif()
  kelpie_strict(${name})
endfunction()

# kelpie_building(LABEL TARGET...): the target LABEL builds a building's targets; the building's
# tests, whose label in ctest is LABEL, add themselves (tests/CMakeLists.txt).
function(kelpie_building label)
  if(PROJECT_IS_TOP_LEVEL)
    add_custom_target(${label} DEPENDS ${ARGN})
  endif()
endfunction()

# kelpie_installs(TARGET NAME): users link TARGET as kelpie::NAME after find_package(kelpie COMPONENTS
# NAME), and within the tree.
function(kelpie_installs target name)
  add_library(kelpie::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
  if(KELPIE_INSTALL)
    install(TARGETS ${target} EXPORT ${target} COMPONENT development)
  endif()
endfunction()
