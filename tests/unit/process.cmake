deltasplat_test(unit/cgroup_test.cpp)
