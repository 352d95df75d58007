deltasplat_test(unit/image_test.cpp)
deltasplat_test(unit/tone_test.cpp)
deltasplat_test(unit/deep_builder_test.cpp)
deltasplat_test(unit/write_deep_image_test.cpp)
