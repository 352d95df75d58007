deltasplat_test(unit/transfer_function_test.cpp)
deltasplat_test(unit/read_transfer_function_test.cpp)
deltasplat_test(unit/presets_test.cpp)
deltasplat_test(unit/class_table_test.cpp)
