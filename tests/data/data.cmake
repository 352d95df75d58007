# These need the data sets beside the repository, and say so where they are not there.
deltasplat_test(data/axis_change_test.cpp)
deltasplat_test(data/tolerance_data_test.cpp)
deltasplat_test(data/convert_data_test.cpp)
deltasplat_test(data/delta_data_test.cpp)
deltasplat_test(data/diff_data_test.cpp)
deltasplat_test(data/ingest_data_test.cpp)
deltasplat_test(data/formats_data_test.cpp)
target_compile_definitions(formats_data_test PRIVATE DELTASPLAT_ITK=$<BOOL:${DELTASPLAT_ITK}>)
