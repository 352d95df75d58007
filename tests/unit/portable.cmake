deltasplat_test(unit/portable_math_test.cpp)
deltasplat_test(unit/default_floats_test.cpp)
