deltasplat_test(unit/camera_test.cpp)
deltasplat_test(unit/factorization_test.cpp)
deltasplat_test(unit/joined_slants_test.cpp)
deltasplat_test(unit/seen_cone_test.cpp)
deltasplat_test(unit/cut_volume_test.cpp)
deltasplat_test(unit/value_window_test.cpp SOURCES
    ${PROJECT_SOURCE_DIR}/tools/render/value_window.cpp)
