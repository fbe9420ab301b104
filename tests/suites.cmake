# SPDX-License-Identifier: Apache-2.0
# After a test program is built: writes TESTS, the file by which ctest knows every suite of PROGRAM as
# one test "NAME.suite". A process for each of the 1,900 tests took 13 to 33 ms of computing, and
# what the tests of a suite share was computed for each anew.
# The label is BUILDING; of a suite whose name begins with Measured or Nightly: measured, nightly.
# Usage: cmake -D PROGRAM= -D NAME= -D BUILDING= -D LONG="suite ..." -D SECONDS= -D EMULATOR="command ..."
#              -D TESTS= -P suites.cmake
cmake_minimum_required(VERSION 3.25)
separate_arguments(LONG)
separate_arguments(EMULATOR)
execute_process(COMMAND ${EMULATOR} "${PROGRAM}" --gtest_list_tests OUTPUT_VARIABLE listed
                TIMEOUT 60 COMMAND_ERROR_IS_FATAL ANY)
list(JOIN EMULATOR "]==] [==[" emulator)
if(emulator)
  set(emulator "[==[${emulator}]==] ")
endif()
string(REPLACE "\n" ";" lines "${listed}")
set(tests)
foreach(line IN LISTS lines)
  if(NOT line MATCHES "^([A-Za-z0-9_/]+)[.]( |$)")
    continue()
  endif()
  set(suite "${CMAKE_MATCH_1}")
  set(label "${BUILDING}")
  if(suite MATCHES "^(Measured|Nightly)")
    string(TOLOWER "${CMAKE_MATCH_1}" label)
  endif()
  set(cost 1)
  if(suite IN_LIST LONG)
    set(cost 50)  # begins early, so that no processor waits for the suite at the end
  endif()
  # Skipped is a suite of which every test was; the end of the output tells that none failed.
  string(APPEND tests
    "add_test([==[${NAME}.${suite}]==] ${emulator}[==[${PROGRAM}]==] [==[--gtest_filter=${suite}.*]==])\n"
    "set_tests_properties([==[${NAME}.${suite}]==] PROPERTIES LABELS ${label} TIMEOUT ${SECONDS} COST ${cost} "
    "SKIP_REGULAR_EXPRESSION [==[  PASSED  . 0 tests[.]\n([^\n]*SKIPPED[^\n]*\n)+$]==])\n")
endforeach()
file(WRITE "${TESTS}" "${tests}")
