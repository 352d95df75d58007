# Delta grids: made, read by every command, restored; and what is refused.
set(cube cube_8x8x8_uint8.raw)

deltasplat_cli_test(delta.fine.raw ARGS delta ${cube} d.vdb --stats s.json CREATES d.vdb s.json)
deltasplat_cli_test(delta.fine.vdb ARGS delta two.vdb d.vdb CREATES d.vdb)
deltasplat_cli_test(delta.fine.empty ARGS delta empty.vdb d.vdb CREATES d.vdb
    STDERR "deltasplat: warning: empty.vdb: grid \"density\": no active voxels")
deltasplat_cli_test(delta.fine.mixed ARGS delta mixed.vdb d.vdb --scalars-only --max-error 0 CREATES d.vdb
    STDERR "deltasplat: warning: mixed.vdb: left out velocity (vec3s)")
deltasplat_cli_test(delta.fine.frustum_first
    ARGS delta frustum_first.vdb d.vdb --scalars-only CREATES d.vdb
    STDERR "deltasplat: warning: frustum_first.vdb: left out density (float, a NonlinearFrustumMap transform)")
deltasplat_cli_test(delta.loses_frustum EXIT 1 ARGS delta frustum_first.vdb d.vdb
    STDERR "deltasplat: warning: frustum_first.vdb: left out density (float, a NonlinearFrustumMap transform)
deltasplat: frustum_first.vdb: got density (float, a NonlinearFrustumMap transform), which no delta grid holds; expected scalar grids alone (--scalars-only leaves out others)")
deltasplat_cli_test(delta.fine.voxels ARGS delta two.vdb d.vdb --no-pack CREATES d.vdb)
deltasplat_cli_test(delta.fine.voxels_empty ARGS delta empty.vdb d.vdb --no-pack CREATES d.vdb
    STDERR "deltasplat: warning: empty.vdb: grid \"density\": no active voxels")
deltasplat_cli_test(delta.fine.voxel_options ARGS delta ${cube} d.vdb --no-pack --axis y --key-interval 16
    --tolerance 0.9 --tolerance-value 50 --codes --max-error 50 CREATES d.vdb
    STDOUT_MATCHES "^largest error [1-9][0-9]*")
deltasplat_cli_test(delta.fine.options ARGS delta ${cube} d.vdb --axis y --key-interval 16
    --tolerance 0.9 --tolerance-value 50 --max-error 50 CREATES d.vdb
    STDOUT_MATCHES "^largest error [1-9][0-9]*")
add_test(NAME cli.delta.round_trip COMMAND bash ${CMAKE_CURRENT_LIST_DIR}/scripts/round_trip.sh
    $<TARGET_FILE:deltasplat_tool> ${CMAKE_CURRENT_BINARY_DIR}/cli/round_trip
    ${DELTASPLAT_FIXTURES}/two.vdb ${DELTASPLAT_FIXTURES}/ball_class.vdb
    ${DELTASPLAT_FIXTURES}/cube_8x8x8_uint8.raw)
set_tests_properties(cli.delta.round_trip PROPERTIES LABELS cli TIMEOUT 120
                     FIXTURES_REQUIRED cli_files)
add_test(NAME cli.far_apart COMMAND bash ${CMAKE_CURRENT_LIST_DIR}/scripts/far_apart.sh
    $<TARGET_FILE:deltasplat_tool> ${CMAKE_CURRENT_BINARY_DIR}/cli/far_apart
    ${DELTASPLAT_FIXTURES}/far.vdb)
set_tests_properties(cli.far_apart PROPERTIES LABELS cli TIMEOUT 120 FIXTURES_REQUIRED cli_files)
add_test(NAME cli.delta.exact COMMAND bash ${CMAKE_CURRENT_LIST_DIR}/scripts/exact_deltas.sh
    $<TARGET_FILE:deltasplat_tool> ${CMAKE_CURRENT_BINARY_DIR}/cli/exact_deltas)
set_tests_properties(cli.delta.exact PROPERTIES LABELS cli TIMEOUT 120)
add_test(NAME cli.delta.input_bytes
    COMMAND bash ${CMAKE_CURRENT_LIST_DIR}/scripts/input_bytes.sh $<TARGET_FILE:deltasplat_tool>
    ${CMAKE_CURRENT_BINARY_DIR}/cli/input_bytes ${DELTASPLAT_FIXTURES} ${DELTASPLAT_CASE_FILES}
    ${DELTASPLAT_DICOM})
set_tests_properties(cli.delta.input_bytes PROPERTIES LABELS cli TIMEOUT 120
                     FIXTURES_REQUIRED cli_files)
deltasplat_cli_test(delta.max_error EXIT 1
    ARGS delta ${cube} d.vdb --tolerance-value 50 --max-error 0.5
    STDERR_MATCHES "deltasplat: grid \"cube_8x8x8_uint8\": got a largest error of [0-9]+; expected at most 0.5 .--max-error.")

# Vectors, and level sets that are no numbers, would be lost with the file that is thrown away.
deltasplat_cli_test(delta.vectors EXIT 1 ARGS delta mixed.vdb d.vdb
    STDERR "deltasplat: mixed.vdb: got velocity (vec3s), which no delta grid holds; expected scalar grids alone (--scalars-only leaves out others)")
deltasplat_cli_test(delta.undefined EXIT 1 ARGS delta cache.vdb d.vdb
    STDERR "deltasplat: warning: cache.vdb: left out phi_obstacle (level set with NaN or infinite values)
deltasplat: cache.vdb: got phi_obstacle (level set with NaN or infinite values), which no delta grid holds; expected scalar grids alone (--scalars-only leaves out others)")
deltasplat_cli_test(delta.vectors_alone EXIT 3 ARGS delta vectors.vdb d.vdb
    STDERR "deltasplat: vectors.vdb: got only velocity (vec3s); expected a scalar grid (float, double, half, int32, int64, bool or mask)")
deltasplat_cli_test(delta.one_beside_vectors ARGS delta mixed.vdb d.vdb --grid density CREATES d.vdb)

deltasplat_cli_test(delta.usage.extension EXIT 2 ARGS delta ${cube} d.nrrd
    STDERR "deltasplat: d.nrrd: got extension \".nrrd\"; expected .vdb")
deltasplat_cli_test(delta.usage.axis EXIT 2 ARGS delta ${cube} d.vdb --axis w
    STDERR "deltasplat: --axis: got w; expected auto, x, y or z")
deltasplat_cli_test(delta.usage.key_interval EXIT 2 ARGS delta ${cube} d.vdb --key-interval 12
    STDERR "deltasplat: --key-interval: got 12; expected a multiple of 8")
deltasplat_cli_test(delta.usage.bits EXIT 2 ARGS delta ${cube} d.vdb --bits 7
    STDERR "deltasplat: --bits: got 7; expected a whole number from 8 to 16")
deltasplat_cli_test(delta.usage.tolerance EXIT 2 ARGS delta ${cube} d.vdb --tolerance-value -1
    STDERR_MATCHES "deltasplat: --tolerance-value: got -1; expected a finite number of at least 0")
deltasplat_cli_test(delta.stats_is_image EXIT 2 ARGS delta stack.\#.pgm d.vdb --stats stack.2.pgm
    STDERR "deltasplat: --stats: got stack.2.pgm; expected another file than the input and the output")
deltasplat_cli_test(delta.fine.wide_integers
    ARGS delta wide_48x48x32_int32.raw d.vdb --bits 9 --max-error 0 CREATES d.vdb
    STDERR "deltasplat: warning: --bits: has no effect on whole numbers")
deltasplat_cli_test(delta.fine.wide_integers_as_codes
    ARGS delta wide_48x48x32_int32.raw d.vdb --codes
    CREATES d.vdb STDOUT_MATCHES "^largest error 2"
    STDERR_MATCHES "^deltasplat: warning: grid \"wide_48x48x32_int32\": more than 65536 different values of type int32, which are rounded by up to 2 .--max-error 0 refuses.")
deltasplat_cli_test(delta.inexact EXIT 1
    ARGS delta wide_48x48x32_int32.raw d.vdb --codes --max-error 0
    STDERR_MATCHES "deltasplat: grid \"wide_48x48x32_int32\": got a largest error of 2; expected at most 0 .--max-error.")
deltasplat_cli_test(delta.no_folder EXIT 4 ARGS delta nowhere.vdb nowhere/d.vdb
    STDERR "deltasplat: nowhere/d.vdb: cannot be written: there is no folder nowhere")
deltasplat_cli_test(delta.full EXIT 4 ARGS delta ${cube} full.vdb
    STDERR "deltasplat: full.vdb: cannot be written: No space left on device")

deltasplat_cli_test(restore.no_deltas EXIT 3 ARGS restore ball.vdb r.vdb
    STDERR "deltasplat: ball.vdb: grid \"density\": got a grid of type float; expected a delta grid (convert takes other grids)")
add_test(NAME cli.restore.other_grids
    COMMAND bash ${CMAKE_CURRENT_LIST_DIR}/scripts/restore_other_grids.sh
    $<TARGET_FILE:deltasplat_tool> $<TARGET_FILE:make_fixtures>
    ${CMAKE_CURRENT_BINARY_DIR}/cli/restore_other_grids ${DELTASPLAT_FIXTURES})
set_tests_properties(cli.restore.other_grids PROPERTIES LABELS cli TIMEOUT 120
                     FIXTURES_REQUIRED cli_files)
deltasplat_cli_test(restore.extension EXIT 2 ARGS restore ball.vdb r.txt
    STDERR_MATCHES "deltasplat: r.txt: got extension \".txt\"; expected .*")
deltasplat_cli_test(restore.stats_is_data EXIT 2 ARGS restore ball.vdb out.mhd --stats out.raw
    STDERR "deltasplat: --stats: got out.raw; expected another file than the input and the output")

# A limit on memory is kept by saying so first.
deltasplat_cli_test(memory.library_refused EXIT 1
    ARGS info frustum.vdb --max-memory 30M
    STDERR_MATCHES "deltasplat: OpenVDB's library: needs 28.0 MiB of memory; expected at most [0-9.]+ MiB, which --max-memory leaves .the program takes [0-9.]+ MiB.")
deltasplat_cli_test(memory.images_library_refused EXIT 1
    ARGS render ${cube} -o refused.jpg --background 0,0,0 --size 8x8 --max-memory 60M
    STDERR_MATCHES "deltasplat: OpenImageIO's library: needs 112.0 MiB of memory; expected at most [0-9.]+ MiB, which --max-memory leaves .the program takes [0-9.]+ MiB.")
deltasplat_cli_test(memory.refused EXIT 1 ARGS render ${cube} -o x.png --max-memory 1K
    STDERR_MATCHES "deltasplat: ${cube}: needs [0-9.]+ .*of memory; expected at most 0 bytes, which --max-memory leaves .the program takes [0-9.]+ MiB.")
deltasplat_cli_test(memory.granted ARGS delta ${cube} d.vdb --max-memory 2G CREATES d.vdb)
deltasplat_cli_test(memory.usage EXIT 2 ARGS info ${cube} --max-memory much
    STDERR "deltasplat: --max-memory: got much; expected a number of bytes, such as 500000000, 400M or 1.5G")
