# Tests that look at pictures and files that the program writes.
find_program(DELTASPLAT_OIIOTOOL oiiotool)
set(DELTASPLAT_CLI_SCRIPTS ${CMAKE_CURRENT_LIST_DIR}/scripts)

function(deltasplat_script_test name script)
    cmake_parse_arguments(PARSE_ARGV 2 ARG "" "" "ARGS;LABELS")
    add_test(NAME cli.${name} COMMAND bash ${DELTASPLAT_CLI_SCRIPTS}/${script} ${ARG_ARGS})
    set_tests_properties(cli.${name} PROPERTIES LABELS "cli;${ARG_LABELS}" TIMEOUT 600)
endfunction()

set(tool $<TARGET_FILE:deltasplat_tool>)
set(scratch ${CMAKE_CURRENT_BINARY_DIR}/cli)
foreach(extension exr png tif jpg)
    deltasplat_script_test(same_bytes.${extension} same_bytes.sh
        ARGS ${tool} ${scratch}/same_bytes_${extension} ${extension})
endforeach()
deltasplat_script_test(progress progress.sh ARGS ${tool} ${scratch}/progress ${DELTASPLAT_FIXTURES})
set_tests_properties(cli.progress PROPERTIES FIXTURES_REQUIRED cli_files)
foreach(signal INT TERM HUP)
    deltasplat_script_test(interrupt.${signal} interrupt.sh
        ARGS ${tool} ${scratch}/interrupt_${signal} ${signal})
endforeach()
deltasplat_script_test(sequence sequence.sh
    ARGS ${tool} ${DELTASPLAT_OIIOTOOL} ${scratch}/sequence)
deltasplat_script_test(sheets_and_movies sheets_and_movies.sh
    ARGS ${tool} ${DELTASPLAT_OIIOTOOL} ${scratch}/sheets_and_movies)
foreach(name start modules)
    deltasplat_script_test(${name} ${name}.sh
        ARGS ${tool} ${DELTASPLAT_OIIOTOOL} ${scratch}/${name} ${DELTASPLAT_FIXTURES}/frustum.vdb)
    set_tests_properties(cli.${name} PROPERTIES FIXTURES_REQUIRED cli_files)
endforeach()
deltasplat_script_test(preview preview.sh
    ARGS ${tool} ${DELTASPLAT_OIIOTOOL} ${scratch}/preview)
deltasplat_script_test(odd_names odd_names.sh ARGS ${tool} ${DELTASPLAT_OIIOTOOL} ${scratch}/odd_names)
deltasplat_script_test(batch batch.sh ARGS ${tool} ${DELTASPLAT_OIIOTOOL} ${scratch}/batch)
# Grids of one file that would have one name are that file's failure, and nobody else's.
deltasplat_cli_test(batch.grids_of_one_name EXIT 3
    ARGS render "odd_grids.*.vdb" -o "p/{name}.{grid}.png" --size 8x8 -q --background 0,0,0 CREATES p
    STDERR_MATCHES "deltasplat: odd_grids.b.vdb, a/b: got p/odd_grids.b.a_b.png for odd_grids.b.vdb, a/b and odd_grids.b.vdb, a_b; expected grids whose names make a file for each .or --grid NAME.
.*
deltasplat: 2 of 6 pictures failed: odd_grids.b.vdb, a/b, odd_grids.b.vdb, a_b")
deltasplat_script_test(converted_sequence converted_sequence.sh
    ARGS ${tool} ${DELTASPLAT_OIIOTOOL} ${scratch}/converted_sequence)
deltasplat_script_test(closed_pipe closed_pipe.sh ARGS ${tool} ${scratch}/closed_pipe)
deltasplat_script_test(interrupt.full_pipe interrupt_full_pipe.sh
    ARGS ${tool} ${scratch}/interrupt_full_pipe)
deltasplat_script_test(interrupt.write interrupt_write.sh ARGS ${tool} ${scratch}/interrupt_write)
deltasplat_script_test(shared_output shared_output.sh ARGS ${tool} ${scratch}/shared_output)
deltasplat_script_test(killed killed.sh ARGS ${tool} ${scratch}/killed)
deltasplat_script_test(few_threads few_threads.sh ARGS ${tool} ${DELTASPLAT_FIXTURES}/frustum.vdb)
deltasplat_script_test(unnamed_grid unnamed_grid.sh
    ARGS ${tool} ${DELTASPLAT_FIXTURES}/unnamed.vdb ${scratch}/unnamed_grid)
set_tests_properties(cli.few_threads PROPERTIES SKIP_RETURN_CODE 77 FIXTURES_REQUIRED cli_files)
set_tests_properties(cli.unnamed_grid PROPERTIES FIXTURES_REQUIRED cli_files)
deltasplat_script_test(inputs_kept inputs_kept.sh
    ARGS ${tool} ${scratch}/inputs_kept $<BOOL:${DELTASPLAT_DICOM}>)
deltasplat_script_test(full_disk.deep full_disk.sh
    ARGS ${tool} ${scratch}/full_disk_deep full.exr
         render input_32x32x32_uint8.raw -o full.exr --size 400x400 --deep)
foreach(file full.exr full.png full.tif full.jpg)
    deltasplat_script_test(full_disk.${file} full_disk.sh
        ARGS ${tool} ${scratch}/full_disk_${file} ${file}
             render input_32x32x32_uint8.raw -o ${file} --size 400x400 --background 0,0,0)
endforeach()
foreach(file full.vdb full_64x64x64_uint8.raw)
    deltasplat_script_test(full_disk.${file} full_disk.sh
        ARGS ${tool} ${scratch}/full_disk_${file} ${file} synth cloud ${file})
endforeach()
add_test(NAME cli.json_keys
         COMMAND ${CMAKE_COMMAND} -DPROGRAM=${tool} -DSCRATCH=${scratch}/json_keys
                 -P ${DELTASPLAT_CLI_SCRIPTS}/json_keys.cmake)
set_tests_properties(cli.json_keys PROPERTIES LABELS cli TIMEOUT 600)

deltasplat_script_test(camera_lock camera_lock.sh
    ARGS ${tool} ${DELTASPLAT_OIIOTOOL} ${scratch}/camera_lock ${DELTASPLAT_FIXTURES})
set_tests_properties(cli.camera_lock PROPERTIES FIXTURES_REQUIRED cli_files)
deltasplat_script_test(fog_over_plate fog_over_plate.sh
    ARGS ${tool} ${DELTASPLAT_OIIOTOOL} ${scratch}/fog_over_plate)
deltasplat_script_test(transfer_functions transfer_functions.sh
    ARGS ${tool} ${DELTASPLAT_OIIOTOOL} ${scratch}/transfer_functions)
deltasplat_script_test(sample_grids sample_grids.sh
    ARGS ${tool} ${DELTASPLAT_OIIOTOOL} ${scratch}/sample_grids)
deltasplat_script_test(shading shading.sh ARGS ${tool} ${DELTASPLAT_OIIOTOOL} ${scratch}/shading)
deltasplat_script_test(surfaces surfaces.sh
    ARGS ${tool} ${DELTASPLAT_OIIOTOOL} ${scratch}/surfaces ${DELTASPLAT_FIXTURES}/level_set.vdb)
set_tests_properties(cli.surfaces PROPERTIES FIXTURES_REQUIRED cli_files)
add_test(NAME cli.first_look
         COMMAND bash ${DELTASPLAT_CLI_SCRIPTS}/if_present.sh
                 ${DELTASPLAT_SHARED_DATA}/dicom_chest_ct
                 bash ${DELTASPLAT_CLI_SCRIPTS}/first_look.sh ${tool} ${DELTASPLAT_OIIOTOOL}
                 ${scratch}/first_look ${DELTASPLAT_SHARED_DATA}/dicom_chest_ct)
set_tests_properties(cli.first_look PROPERTIES LABELS "cli;data" TIMEOUT 600 SKIP_RETURN_CODE 77)
deltasplat_script_test(deep deep.sh ARGS ${tool} ${DELTASPLAT_OIIOTOOL} ${scratch}/deep)
deltasplat_script_test(modes modes.sh ARGS ${tool} ${DELTASPLAT_OIIOTOOL} ${scratch}/modes)
deltasplat_script_test(colors colors.sh
    ARGS ${tool} ${DELTASPLAT_OIIOTOOL} ${scratch}/colors ${CMAKE_CURRENT_LIST_DIR}/data)
deltasplat_script_test(exr exr.sh ARGS ${tool} ${DELTASPLAT_OIIOTOOL} ${scratch}/exr)
deltasplat_script_test(tone tone.sh ARGS ${tool} ${DELTASPLAT_OIIOTOOL} ${scratch}/tone)
deltasplat_script_test(labels_first labels_first.sh
    ARGS ${tool} ${DELTASPLAT_OIIOTOOL} ${scratch}/labels_first)
deltasplat_script_test(units units.sh ARGS ${tool} ${DELTASPLAT_OIIOTOOL} ${scratch}/units)
deltasplat_script_test(annotations annotations.sh
    ARGS ${tool} ${DELTASPLAT_OIIOTOOL} ${scratch}/annotations)
deltasplat_script_test(identity.simd identity.sh
    ARGS ${tool} ${DELTASPLAT_OIIOTOOL} ${scratch}/identity_simd every synth --size 90x70)
deltasplat_script_test(identity.fine identity.sh
    ARGS ${tool} ${DELTASPLAT_OIIOTOOL} ${scratch}/identity_fine every synth --size 90x70
         --sigma 0.7 --resolution 3)
deltasplat_script_test(identity.lit identity.sh
    ARGS ${tool} ${DELTASPLAT_OIIOTOOL} ${scratch}/identity_lit every synth --size 90x70
         --light view:1,-1,-1 --light head:0.5)

# The promise on real data; without the data the tests are there and say that they were skipped.
function(deltasplat_identity_test name file transfer_function)
    set(test cli.identity.${name})
    set(volume ${DELTASPLAT_SHARED_DATA}/${file})
    add_test(NAME ${test}
             COMMAND bash ${DELTASPLAT_CLI_SCRIPTS}/if_present.sh ${volume}
                     bash ${DELTASPLAT_CLI_SCRIPTS}/identity.sh $<TARGET_FILE:deltasplat_tool>
                     ${DELTASPLAT_OIIOTOOL} ${CMAKE_CURRENT_BINARY_DIR}/cli/identity_${name} best
                     ${volume} --size 256x256
                     --tf ${DELTASPLAT_SHARED_DATA}/../bench/${transfer_function})
    set_tests_properties(${test} PROPERTIES LABELS "cli;data" TIMEOUT 600 SKIP_RETURN_CODE 77)
endfunction()
deltasplat_identity_test(engine engine/engine_256x256x128_uint8.raw.gz tf_ct.json)
deltasplat_identity_test(head ct_head/cthead_256x256x225_uint8.raw.gz tf_ct.json)
deltasplat_identity_test(fuel fuel/fuel_64x64x64_uint8.raw tf_ct.json)
deltasplat_identity_test(aneurism aneurism/aneurism_256x256x256_uint8.raw.gz tf_ct.json)
deltasplat_identity_test(lobster lobster/lobster_301x324x56_uint8.raw.gz tf_ct.json)
deltasplat_identity_test(teapot boston_teapot/boston_teapot_256x256x178_uint8.raw.gz tf_ct.json)
deltasplat_identity_test(smoke vdb_smoke/smoke.vdb tf_fog.json)
deltasplat_identity_test(anisotropic_fog vdb_anisotropic_fog/test.vdb tf_fog.json)
