# The odd files that the command-line tests are given.
add_executable(make_fixtures ${CMAKE_CURRENT_LIST_DIR}/make_fixtures.cpp
               ${CMAKE_CURRENT_LIST_DIR}/make_several.cpp)
target_link_libraries(make_fixtures PRIVATE OpenVDB::openvdb TBB::tbb ZLIB::ZLIB)
deltasplat_compile_options(make_fixtures)
file(MAKE_DIRECTORY ${DELTASPLAT_FIXTURES})
add_test(NAME cli.fixtures COMMAND make_fixtures WORKING_DIRECTORY ${DELTASPLAT_FIXTURES})
set_tests_properties(cli.fixtures PROPERTIES FIXTURES_SETUP cli_files LABELS cli)
