deltasplat_test(unit/cgroup_test.cpp)
deltasplat_test(unit/shared_folder_test.cpp)
deltasplat_test(unit/paired_files_test.cpp)
