# Every target is also a plain program that replays mutations of its own seeds, so that the readers
# of foreign bytes are tested wherever the other tests are.
# MUTATIONS: so many of each seed are also replayed with two kinds of unwritten memory.
# Usage: deltasplat_fuzz(vdb_fuzz [SOURCES more.cpp] [MUTATIONS 50])
function(deltasplat_fuzz name)
    cmake_parse_arguments(ARG "" "MUTATIONS" "SOURCES" ${ARGN})
    set(programs ${name}_replay)
    set(sources fuzz/${name}.cpp fuzz/fuzz_target.cpp fuzz/capped_new.cpp ${ARG_SOURCES})
    add_executable(${name}_replay ${sources} fuzz/replay_main.cpp)
    add_test(NAME fuzz.${name} COMMAND ${name}_replay)
    set_tests_properties(fuzz.${name} PROPERTIES LABELS fuzz TIMEOUT 600)
    if(ARG_MUTATIONS)
        add_test(NAME fuzz.same_memory.${name}
            COMMAND bash ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/scripts/same_memory.sh
                    $<TARGET_FILE:${name}_replay> ${ARG_MUTATIONS}
                    ${CMAKE_CURRENT_BINARY_DIR}/fuzz/${name})
        set_tests_properties(fuzz.same_memory.${name} PROPERTIES LABELS fuzz TIMEOUT 600)
    endif()
    if(DELTASPLAT_FUZZ)
        add_executable(${name} ${sources})
        target_link_options(${name} PRIVATE -fsanitize=fuzzer)
        list(APPEND programs ${name})
    endif()
    foreach(program ${programs})
        target_include_directories(${program} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}
            ${PROJECT_SOURCE_DIR}/src ${PROJECT_SOURCE_DIR}/tools)
        target_link_libraries(${program} PRIVATE deltasplat::deltasplat OpenVDB::openvdb
            OpenImageIO::OpenImageIO ZLIB::ZLIB GTest::gtest)
        deltasplat_compile_options(${program})
    endforeach()
endfunction()

deltasplat_fuzz(delta_fuzz MUTATIONS 50)
deltasplat_fuzz(raw_fuzz MUTATIONS 10)
deltasplat_fuzz(raw_name_fuzz SOURCES ${PROJECT_SOURCE_DIR}/tools/options/parse.cpp)
deltasplat_fuzz(transfer_function_fuzz)
deltasplat_fuzz(slab_fuzz)
deltasplat_fuzz(vdb_fuzz MUTATIONS 50)
deltasplat_fuzz(image_fuzz MUTATIONS 400)
deltasplat_fuzz(nifti_fuzz MUTATIONS 50)
deltasplat_fuzz(npy_fuzz MUTATIONS 50)
if(DELTASPLAT_DICOM)
    deltasplat_fuzz(dicom_fuzz MUTATIONS 100)
endif()
deltasplat_fuzz(text_formats_fuzz MUTATIONS 100)
