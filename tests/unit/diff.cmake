deltasplat_test(unit/compare_volumes_test.cpp)
