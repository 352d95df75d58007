deltasplat_test(property/identity_test.cpp)
