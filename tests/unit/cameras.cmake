deltasplat_test(unit/film_camera_test.cpp)
deltasplat_test(unit/json_camera_test.cpp)
deltasplat_test(unit/usd_camera_test.cpp)
deltasplat_test(unit/exr_camera_test.cpp)
