deltasplat_test(unit/image_test.cpp)
deltasplat_test(unit/tone_test.cpp)
