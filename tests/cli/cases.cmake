# Defines deltasplat_cli_test(NAME ARGS arguments... [EXIT code] [STDERR "text" | STDERR_MATCHES
# "regex"] [STDOUT_MATCHES "regex"] [CREATES files...]): runs the program in a folder that holds the
# fixtures and checks its exit code, the whole of standard error (lines of progress aside) and which
# files are new. Included first, by its name's place in the alphabet or by who comes before it.
include_guard()
set(DELTASPLAT_CASE ${CMAKE_CURRENT_LIST_DIR}/scripts/case.sh)
set(DELTASPLAT_CASE_FILES ${CMAKE_CURRENT_LIST_DIR}/data)
set(DELTASPLAT_FIXTURES ${CMAKE_CURRENT_BINARY_DIR}/cli/fixtures)

function(deltasplat_cli_test name)
    cmake_parse_arguments(PARSE_ARGV 1 ARG "" "EXIT;STDERR;STDERR_MATCHES;STDOUT_MATCHES"
                          "ARGS;CREATES")
    if(ARG_UNPARSED_ARGUMENTS OR NOT DEFINED ARG_ARGS)
        message(FATAL_ERROR "deltasplat_cli_test(${name}): ARGS missing, or what is "
                            "'${ARG_UNPARSED_ARGUMENTS}'?")
    endif()
    if(NOT DEFINED ARG_EXIT)
        set(ARG_EXIT 0)
    endif()
    list(JOIN ARG_CREATES ":" creates)
    add_test(NAME cli.${name}
             COMMAND bash ${DELTASPLAT_CASE} scratch=${CMAKE_CURRENT_BINARY_DIR}/cli/cases/${name}
                     given=${DELTASPLAT_FIXTURES}:${DELTASPLAT_CASE_FILES} exit=${ARG_EXIT}
                     "stderr=${ARG_STDERR}" "stderr_matches=${ARG_STDERR_MATCHES}"
                     "stdout_matches=${ARG_STDOUT_MATCHES}" "creates=${creates}"
                     -- $<TARGET_FILE:deltasplat_tool> ${ARG_ARGS})
    set_tests_properties(cli.${name} PROPERTIES LABELS cli TIMEOUT 120 FIXTURES_REQUIRED cli_files)
endfunction()
