# What `bench` measures with and says; measuring itself depends on the machine.
set(tools ${PROJECT_SOURCE_DIR}/tools)
deltasplat_test(unit/bench_runs_test.cpp SOURCES ${tools}/bench/bench_runs.cpp
    ${tools}/bench/bench_words.cpp ${tools}/render/render_stats.cpp ${tools}/version.cpp
    ${tools}/volume_place.cpp ${tools}/options/parse.cpp)
target_compile_definitions(bench_runs_test PRIVATE DELTASPLAT_VERSION="${PROJECT_VERSION}")
deltasplat_test(unit/bench_picture_test.cpp SOURCES ${tools}/bench/bench_page_file.cpp
    ${tools}/bench/heat_map.cpp ${tools}/page/picture_data.cpp)
deltasplat_test(unit/table1_test.cpp SOURCES ${tools}/table1/ct_ramp.cpp ${tools}/table1/table1.cpp)
