deltasplat_test(property/identity_test.cpp)
deltasplat_test(property/thin_test.cpp)
deltasplat_test(property/cut_test.cpp)
deltasplat_test(property/tolerance_test.cpp)
