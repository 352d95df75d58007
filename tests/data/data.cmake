# These need the data sets beside the repository, and say so where they are not there.
deltasplat_tests(data_tests data
    data/axis_change_test.cpp data/perspective_data_test.cpp data/tolerance_data_test.cpp
    data/convert_data_test.cpp data/delta_data_test.cpp data/diff_data_test.cpp
    data/ingest_data_test.cpp data/formats_data_test.cpp)
target_compile_definitions(data_tests PRIVATE DELTASPLAT_DICOM=$<BOOL:${DELTASPLAT_DICOM}>)
