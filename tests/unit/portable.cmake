deltasplat_test(unit/portable_math_test.cpp)
