deltasplat_test(unit/camera_test.cpp)
deltasplat_test(unit/factorization_test.cpp)
deltasplat_test(unit/value_window_test.cpp SOURCES ${PROJECT_SOURCE_DIR}/tools/value_window.cpp)
target_include_directories(value_window_test PRIVATE ${PROJECT_SOURCE_DIR}/tools)
