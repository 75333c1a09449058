# SPDX-License-Identifier: BSD-3-Clause
# shoal_describe_program(<target> [DESTINATION <folder>] [COMPONENT <component>])
# After each link of the program <target>, writes the output of `<target> --describe` beside it, as NAME.args.yaml, by
# which `shoal check` checks the `args:` of a process in a world.  With DESTINATION both are installed there.
function(shoal_describe_program target)
  cmake_parse_arguments(ARG "" "DESTINATION;COMPONENT" "" ${ARGN})
  set(declaration $<TARGET_FILE:${target}>.args.yaml)
  add_custom_command(TARGET ${target} POST_BUILD COMMAND $<TARGET_FILE:${target}> --describe > ${declaration}
                     COMMENT "Declaration of the arguments of ${target}" VERBATIM)
  set_property(TARGET ${target} APPEND PROPERTY ADDITIONAL_CLEAN_FILES ${declaration})
  if(ARG_DESTINATION)
    set(component)
    if(ARG_COMPONENT)
      set(component COMPONENT ${ARG_COMPONENT})
    endif()
    install(TARGETS ${target} RUNTIME DESTINATION ${ARG_DESTINATION} ${component})
    install(FILES ${declaration} DESTINATION ${ARG_DESTINATION} ${component})
  endif()
endfunction()
