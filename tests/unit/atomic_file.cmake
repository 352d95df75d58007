deltasplat_test(unit/atomic_file_test.cpp)
