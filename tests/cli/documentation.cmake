# Every command line in the documents is run.
file(GLOB DELTASPLAT_DOCUMENTS CONFIGURE_DEPENDS
     ${PROJECT_SOURCE_DIR}/README.md ${PROJECT_SOURCE_DIR}/docs/*.md)
foreach(document ${DELTASPLAT_DOCUMENTS})
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${document})
    file(STRINGS ${document} commands REGEX "^ *```sh *$")
    if(NOT commands)
        continue()
    endif()
    file(RELATIVE_PATH name ${PROJECT_SOURCE_DIR} ${document})
    string(MAKE_C_IDENTIFIER ${name} folder)
    add_test(NAME cli.document.${name}
             COMMAND bash ${CMAKE_CURRENT_LIST_DIR}/scripts/documentation.sh
                     $<TARGET_FILE:deltasplat_tool> ${PROJECT_SOURCE_DIR}
                     ${CMAKE_CURRENT_BINARY_DIR}/cli/${folder} ${document})
    set_tests_properties(cli.document.${name} PROPERTIES LABELS cli TIMEOUT 600)
endforeach()
