deltasplat_test(unit/cut_into_lights_test.cpp)
deltasplat_test(unit/point_depths_test.cpp)
deltasplat_test(unit/read_environment_test.cpp)
deltasplat_test(unit/sky_test.cpp)
