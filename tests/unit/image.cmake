deltasplat_test(unit/image_test.cpp)
