deltasplat_tests(golden_tests golden golden/golden_test.cpp
    SOURCES golden/golden_scenes.cpp golden/golden_volumes.cpp)
# glibc then takes its functions for processors without FMA.
add_test(NAME golden.without_fma COMMAND golden_tests)
set_tests_properties(golden.without_fma PROPERTIES LABELS golden TIMEOUT 600
    ENVIRONMENT GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2,-FMA,-AVX512F)
add_test(NAME golden.no_library_functions
    COMMAND ${CMAKE_COMMAND} -DSOURCES=${PROJECT_SOURCE_DIR}/src
        -P ${CMAKE_CURRENT_SOURCE_DIR}/golden/scripts/no_library_functions.cmake)
set_tests_properties(golden.no_library_functions PROPERTIES LABELS golden)
