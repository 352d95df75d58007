deltasplat_test(unit/cgroup_test.cpp)
deltasplat_test(unit/checked_json_test.cpp)
deltasplat_test(unit/shared_folder_test.cpp)
deltasplat_test(unit/commit_pair_test.cpp)
set(tools ${PROJECT_SOURCE_DIR}/tools)
deltasplat_test(unit/flag_names_test.cpp SOURCES ${tools}/flag_names.cpp)
deltasplat_test(unit/large_pages_test.cpp SOURCES ${tools}/process/large_pages.cpp
                ${tools}/process/reuse_memory.cpp)
deltasplat_test(unit/interrupt_test.cpp SOURCES ${tools}/process/interrupt.cpp)
deltasplat_test(unit/in_child_test.cpp SOURCES ${tools}/process/interrupt.cpp)
deltasplat_test(unit/listener_test.cpp SOURCES ${tools}/listener.cpp ${tools}/flag_names.cpp
                ${tools}/process/interrupt.cpp ${tools}/process/run_log.cpp ${tools}/process/tell_place.cpp)
