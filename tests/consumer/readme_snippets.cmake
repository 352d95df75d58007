# The README's C++ compiles with the headers that it shows.
set(readme ${PROJECT_SOURCE_DIR}/README.md)
set(snippets ${CMAKE_CURRENT_BINARY_DIR}/consumer/readme)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${readme})
file(MAKE_DIRECTORY ${snippets})
execute_process(COMMAND awk -v folder=${snippets} -f ${CMAKE_CURRENT_LIST_DIR}/scripts/snippets.awk
                        ${readme}
                COMMAND_ERROR_IS_FATAL ANY)
add_library(readme_snippets OBJECT ${snippets}/1.cpp)
target_link_libraries(readme_snippets PRIVATE deltasplat::deltasplat)
