deltasplat_test(property/delta_file_test.cpp SOURCES reference/plain_delta_reader.cpp)
deltasplat_test(property/delta_leaves_test.cpp)
