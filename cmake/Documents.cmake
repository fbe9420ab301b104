# SPDX-License-Identifier: Apache-2.0
# The manual and the completions, as the built command prints them.

# kelpie_document(FILE DESTINATION folder COMMAND words...)
function(kelpie_document file)
  cmake_parse_arguments(arg "" "DESTINATION" "COMMAND" ${ARGN})
  add_custom_command(OUTPUT "${generated_dir}/${file}"
    COMMAND kelpie_cli ${arg_COMMAND} > "${generated_dir}/${file}"
    DEPENDS kelpie_cli VERBATIM)
  install(FILES "${generated_dir}/${file}"
          DESTINATION "${CMAKE_INSTALL_DATADIR}/${arg_DESTINATION}" COMPONENT runtime)
endfunction()

kelpie_document(kelpie.1 DESTINATION man/man1 COMMAND manual)
kelpie_document(kelpie DESTINATION bash-completion/completions COMMAND completion bash)
kelpie_document(_kelpie DESTINATION zsh/site-functions COMMAND completion zsh)
# Debian's zsh looks elsewhere.
install(FILES "${generated_dir}/_kelpie"
        DESTINATION "${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions"
        COMPONENT debian_kelpie-tools EXCLUDE_FROM_ALL)
add_custom_target(kelpie_documents ALL
  DEPENDS "${generated_dir}/kelpie.1" "${generated_dir}/kelpie" "${generated_dir}/_kelpie")
