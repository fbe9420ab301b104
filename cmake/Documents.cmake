# SPDX-License-Identifier: Apache-2.0
# Bills of materials; the manual page, which help2man makes of `kelpie --help-all` and kelpie.h2m; the
# completions, which kelpie prints itself. Manual and completions have to run kelpie.
find_package(Python3 QUIET COMPONENTS Interpreter)
find_program(DPKG_QUERY dpkg-query)

# kelpie_bill(TARGET COMPONENT NAME): installs the bill of materials of a target, which
# scripts/sbom.py makes where packages of Debian are known: not of libraries in a folder of their own.
function(kelpie_bill target component name)
  if(NOT Python3_Interpreter_FOUND OR NOT DPKG_QUERY OR CMAKE_TOOLCHAIN_FILE)
    message(STATUS "kelpie: no bill of materials of ${target}, which needs Python and dpkg")
    return()
  endif()
  set(bill "${generated_dir}/${name}.spdx.json")
  add_custom_command(OUTPUT "${bill}"
    COMMAND "${Python3_EXECUTABLE}" "${PROJECT_SOURCE_DIR}/scripts/sbom.py" "${PROJECT_BINARY_DIR}"
            "$<TARGET_FILE:${target}>" "${bill}"
    DEPENDS ${target} "${PROJECT_SOURCE_DIR}/scripts/sbom.py" VERBATIM)
  add_custom_target(${target}_bill ALL DEPENDS "${bill}")
  set(maybe)
  if(component STREQUAL "python")
    set(maybe EXCLUDE_FROM_ALL)
  endif()
  install(FILES "${bill}" DESTINATION "${CMAKE_INSTALL_DATADIR}/kelpie" COMPONENT ${component}
          ${maybe})
endfunction()
kelpie_bill(kelpie_cli runtime kelpie)
if(KELPIE_BUILD_PYTHON)
  kelpie_bill(kelpie_python python python3-kelpie)
endif()
if(CMAKE_CROSSCOMPILING)
  message(STATUS "kelpie: a cross build has neither manual page nor completions")
  return()
endif()

foreach(shell IN ITEMS bash zsh)
  add_custom_command(OUTPUT "${generated_dir}/completion.${shell}"
    COMMAND kelpie_cli completion ${shell} > "${generated_dir}/completion.${shell}"
    DEPENDS kelpie_cli VERBATIM)
endforeach()
set(documents "${generated_dir}/completion.bash" "${generated_dir}/completion.zsh")
install(FILES "${generated_dir}/completion.bash" RENAME kelpie COMPONENT runtime
        DESTINATION "${CMAKE_INSTALL_DATADIR}/bash-completion/completions")
install(FILES "${generated_dir}/completion.zsh" RENAME _kelpie COMPONENT runtime
        DESTINATION "${CMAKE_INSTALL_DATADIR}/zsh/site-functions")

find_program(HELP2MAN help2man)
if(HELP2MAN)
  # The page's date: the same sources make the same page.
  set(page_date "$ENV{SOURCE_DATE_EPOCH}")
  if(page_date STREQUAL "")
    set(page_date 1793491200)  # November 2026
  endif()
  add_custom_command(OUTPUT "${generated_dir}/kelpie.1"
    COMMAND "${CMAKE_COMMAND}" -E env SOURCE_DATE_EPOCH=${page_date}
            "${HELP2MAN}" --no-info --help-option=--help-all
            "--include=${CMAKE_CURRENT_LIST_DIR}/kelpie.h2m"
            "--output=${generated_dir}/kelpie.1" "$<TARGET_FILE:kelpie_cli>"
    DEPENDS kelpie_cli "${CMAKE_CURRENT_LIST_DIR}/kelpie.h2m" VERBATIM)
  find_program(GZIP gzip REQUIRED)
  add_custom_command(OUTPUT "${generated_dir}/kelpie.1.gz"
    COMMAND "${GZIP}" -9nkf "${generated_dir}/kelpie.1"
    DEPENDS "${generated_dir}/kelpie.1" VERBATIM)
  list(APPEND documents "${generated_dir}/kelpie.1.gz")
  install(FILES "${generated_dir}/kelpie.1.gz" COMPONENT runtime
          DESTINATION "${CMAKE_INSTALL_MANDIR}/man1")
else()
  message(STATUS "kelpie: built without its manual page, which help2man would make")
endif()
add_custom_target(kelpie_documents ALL DEPENDS ${documents})
