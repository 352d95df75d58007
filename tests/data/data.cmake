# These need the data sets beside the repository, and say so where they are not there.
deltasplat_test(data/axis_change_test.cpp)
deltasplat_test(data/diff_data_test.cpp)
deltasplat_test(data/ingest_data_test.cpp)
