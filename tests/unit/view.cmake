deltasplat_test(unit/camera_test.cpp)
deltasplat_test(unit/factorization_test.cpp)
