# SPDX-License-Identifier: Apache-2.0
# The manual page, which help2man makes of `kelpie --help-all` and kelpie.h2m, and the completions,
# which kelpie prints itself. All of them have to run kelpie.
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
# Debian's zsh looks elsewhere.
install(FILES "${generated_dir}/completion.zsh" RENAME _kelpie
        DESTINATION "${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions"
        COMPONENT debian_kelpie-tools EXCLUDE_FROM_ALL)

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
