# Every target is also a plain program that replays mutations of its own seeds, so that the readers
# of foreign bytes are tested wherever the other tests are.
function(deltasplat_fuzz name)
    set(programs ${name}_replay)
    set(sources fuzz/${name}.cpp fuzz/fuzz_target.cpp fuzz/capped_new.cpp)
    add_executable(${name}_replay ${sources} fuzz/replay_main.cpp)
    add_test(NAME fuzz.${name} COMMAND ${name}_replay)
    set_tests_properties(fuzz.${name} PROPERTIES LABELS fuzz TIMEOUT 600)
    if(DELTASPLAT_FUZZ)
        add_executable(${name} ${sources})
        target_link_options(${name} PRIVATE -fsanitize=fuzzer)
        list(APPEND programs ${name})
    endif()
    foreach(program ${programs})
        target_include_directories(${program} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}
                                   ${PROJECT_SOURCE_DIR}/src)
        target_link_libraries(${program} PRIVATE deltasplat::deltasplat OpenVDB::openvdb ZLIB::ZLIB)
        deltasplat_compile_options(${program})
    endforeach()
endfunction()

deltasplat_fuzz(raw_fuzz)
deltasplat_fuzz(vdb_fuzz)
