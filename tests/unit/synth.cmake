deltasplat_test(unit/analytic_volume_test.cpp)
deltasplat_test(unit/fire_test.cpp)
deltasplat_test(unit/write_analytic_test.cpp)
