# convert: what it writes, what it says was lost, what it refuses.
set(cube cube_8x8x8_uint8.raw)
set(half "uint8 stored as half, which holds every value")

deltasplat_cli_test(help_convert ARGS convert --help
    STDOUT_MATCHES "--background.*V.auto.none.*--level-set.*default keep.*Examples:.*deltasplat convert.*deltasplat convert")

# What is written, and what is said about it.
deltasplat_cli_test(convert.vdb ARGS convert ${cube} out.vdb CREATES out.vdb
    STDERR "deltasplat: warning: out.vdb: ${half}")
deltasplat_cli_test(convert.float ARGS convert ${cube} out.vdb --float CREATES out.vdb
    STDERR "deltasplat: warning: out.vdb: uint8 stored as float, which holds every value")
deltasplat_cli_test(convert.quiet ARGS convert ${cube} out.vdb -qq CREATES out.vdb)
foreach(file out.nrrd out.mha OUT.NRRD out_8x8x8_uint8.raw out_8x8x8_uint8le.raw.gz)
    deltasplat_cli_test(convert.${file} ARGS convert ${cube} ${file} CREATES ${file})
endforeach()
deltasplat_cli_test(convert.nhdr ARGS convert ${cube} out.nhdr CREATES out.nhdr out.raw.gz)
deltasplat_cli_test(convert.mhd ARGS convert ${cube} out.mhd CREATES out.mhd out.raw)
foreach(file out.nii out.nii.gz)
    deltasplat_cli_test(convert.${file} ARGS convert ${cube} ${file} CREATES ${file}
        STDERR "deltasplat: warning: ${file}: no patient space is known; NIfTI takes world space for RAS")
endforeach()
deltasplat_cli_test(convert.raw ARGS convert ${cube} out.raw --spacing 1,1,2 CREATES out.raw
    STDERR "deltasplat: warning: out.raw: no header; read it with --dims 8x8x8 --type uint8 --spacing 1,1,2")
deltasplat_cli_test(convert.raw_name ARGS convert ${cube} out.raw CREATES out.raw
    STDERR "deltasplat: warning: out.raw: no header; read it with --dims 8x8x8 --type uint8")
deltasplat_cli_test(convert.verbose ARGS convert ${cube} out.nrrd -v CREATES out.nrrd
    STDERR_MATCHES "512 of 512 voxels active, code book integer.*512 bytes read, [0-9]+ bytes written, largest error 0, .*")

deltasplat_cli_test(convert.all_grids ARGS convert two.vdb out.vdb CREATES out.vdb)
deltasplat_cli_test(convert.one_grid ARGS convert two.vdb out.vdb --grid heat CREATES out.vdb)
deltasplat_cli_test(convert.other_grids ARGS convert mixed.vdb out.vdb CREATES out.vdb
    STDERR "deltasplat: warning: mixed.vdb: left out velocity (vec3s)")
deltasplat_cli_test(convert.other_type ARGS convert other_type.vdb out.vdb CREATES out.vdb
    STDERR "deltasplat: warning: other_type.vdb: left out density (uint8)")
deltasplat_cli_test(convert.frustum_first ARGS convert frustum_first.vdb out.vdb CREATES out.vdb
    STDERR "deltasplat: warning: frustum_first.vdb: left out density (float, a NonlinearFrustumMap transform)")
deltasplat_cli_test(convert.first_grid ARGS convert two.vdb out_13x13x13_float32.raw
    CREATES out_13x13x13_float32.raw
    STDERR "deltasplat: warning: two.vdb: reading grid \"density\" of 2 scalar grids (--grid chooses another)
deltasplat: warning: out_13x13x13_float32.raw: no header; read it with --origin -6,-6,-6
deltasplat: warning: out_13x13x13_float32.raw: 1272 inactive voxels become voxels like the others, with the value they hold (background 0)
deltasplat: warning: out_13x13x13_float32.raw: the grid's name \"density\", class \"fog volume\" and other metadata are left out")
deltasplat_cli_test(convert.empty ARGS convert empty.vdb out.vdb CREATES out.vdb
    STDERR "deltasplat: warning: empty.vdb: grid \"density\": no active voxels")

# What is refused, before anything is read where that is possible.
deltasplat_cli_test(convert.no_output EXIT 2 ARGS convert ${cube}
    STDERR "deltasplat: OUTPUT: got nothing; expected FILE (see 'deltasplat convert --help')")
foreach(file out.txt out out.gz)
    string(REGEX MATCH "[.].*$" extension ${file})
    deltasplat_cli_test(convert.format.${file} EXIT 2 ARGS convert nowhere.vdb ${file}
        STDERR "deltasplat: ${file}: got extension \"${extension}\"; expected .vdb, .raw, .raw.gz, .npy, .nrrd, .nhdr, .mhd, .mha, .nii or .nii.gz")
endforeach()
deltasplat_cli_test(convert.background EXIT 2 ARGS convert ${cube} out.vdb --background air
    STDERR "deltasplat: --background: got air; expected a finite number, auto or none")
deltasplat_cli_test(convert.stats_is_output EXIT 2
    ARGS convert ${cube} out.vdb --stats ./out.vdb
    STDERR "deltasplat: --stats: got ./out.vdb; expected another file than the input and the output")
deltasplat_cli_test(convert.stats_is_data EXIT 2 ARGS convert ${cube} out.mhd --stats out.raw
    STDERR "deltasplat: --stats: got out.raw; expected another file than the input and the output")
deltasplat_cli_test(convert.data_is_input EXIT 2
    ARGS convert plain.raw plain.mhd --dims 8x8x8 --type uint8
    STDERR "deltasplat: plain.mhd: got the input plain.raw as its data file; expected another name")
# A header's data is as much the input as the header.
deltasplat_cli_test(convert.data_is_inputs_data EXIT 2 ARGS convert detached.nhdr detached.mhd
    STDERR "deltasplat: detached.mhd: got the input detached.raw as its data file; expected another name")
deltasplat_cli_test(convert.output_is_inputs_data EXIT 2 ARGS convert detached.nhdr detached.raw
    STDERR "deltasplat: detached.raw: got a file of the input detached.nhdr; expected another name")
deltasplat_cli_test(convert.stats_is_inputs_data EXIT 2
    ARGS convert detached.nhdr out.vdb --stats detached.raw
    STDERR "deltasplat: --stats: got detached.raw; expected another file than the input and the output")
deltasplat_cli_test(convert.empty_box EXIT 3 ARGS convert empty.vdb out.nrrd
    STDERR "deltasplat: warning: empty.vdb: grid \"density\": no active voxels
deltasplat: out.nrrd: got \"density\", which has no active voxels; expected a volume with a bounding box (.vdb holds empty ones)")
deltasplat_cli_test(convert.cut EXIT 3 ARGS convert cut_8x8x8_uint8.raw out.vdb
    STDERR "deltasplat: cut_8x8x8_uint8.raw: got 500 bytes; expected 512 (8x8x8 uint8)")
deltasplat_cli_test(convert.no_folder EXIT 4 ARGS convert nowhere.vdb nowhere/out.vdb
    STDERR "deltasplat: nowhere/out.vdb: cannot be written: there is no folder nowhere")
foreach(file full.vdb full.raw full.nrrd full.mha full.nii.gz)
    deltasplat_cli_test(convert.${file} EXIT 4 ARGS convert ${cube} ${file}
        STDERR "deltasplat: ${file}: cannot be written: No space left on device")
endforeach()
# Half a pair is nothing.
deltasplat_cli_test(convert.full_data EXIT 4 ARGS convert ${cube} full.mhd
    STDERR "deltasplat: full.raw: cannot be written: No space left on device")

deltasplat_cli_test(convert.unused.float ARGS convert ${cube} out.nrrd --float CREATES out.nrrd
    STDERR "deltasplat: warning: --float: has no effect without a .vdb output")
deltasplat_cli_test(convert.unused.background ARGS convert ${cube} out.nrrd --background 0
    CREATES out.nrrd
    STDERR "deltasplat: warning: --background: has no effect without a .vdb output")

# A name that says something else than the file would be believed by whoever reads it.
deltasplat_cli_test(convert.name_of_other_order EXIT 2
    ARGS convert cube_8x8x8_uint8.raw a_8x8x4_uint8.raw
    STDERR "deltasplat: a_8x8x4_uint8.raw: got a name that says 8x8x4 uint8; expected 8x8x8 uint8, or a name that says nothing")
deltasplat_cli_test(convert.name_of_other_type EXIT 2
    ARGS convert wide_48x48x32_int32.raw a_48x48x32_uint32be.raw
    STDERR "deltasplat: a_48x48x32_uint32be.raw: got a name that says 48x48x32 uint32be; expected 48x48x32 int32be, or a name that says nothing")
add_test(NAME cli.convert.big_endian COMMAND bash ${CMAKE_CURRENT_LIST_DIR}/scripts/big_endian.sh
    $<TARGET_FILE:deltasplat_tool> ${CMAKE_CURRENT_BINARY_DIR}/cli/big_endian
    ${DELTASPLAT_FIXTURES})
set_tests_properties(cli.convert.big_endian PROPERTIES LABELS cli TIMEOUT 120
                     FIXTURES_REQUIRED cli_files)
deltasplat_cli_test(synth.name_of_other_dims EXIT 2
    ARGS synth slab a_8x8x4_uint8.raw --dims 8x8x8
    STDERR "deltasplat: a_8x8x4_uint8.raw: got a name that says 8x8x4 uint8; expected 8x8x8 uint8, or a name that says nothing")
deltasplat_cli_test(convert.name_of_same ARGS convert cube_8x8x8_uint8.raw a_8x8x8_uint8be.raw
    CREATES a_8x8x8_uint8be.raw)
