# Outputs that cannot be written: exit code 4, and nothing left.
set(cube cube_8x8x8_uint8.raw)

deltasplat_cli_test(output.no_folder EXIT 4 ARGS render ${cube} -o nowhere/out.exr
    STDERR "deltasplat: nowhere/out.exr: cannot be written: there is no folder nowhere")
deltasplat_cli_test(output.is_folder EXIT 4 ARGS render ${cube} -o folder.exr
    STDERR "deltasplat: folder.exr: cannot be written: Is a directory")
deltasplat_cli_test(output.before_input EXIT 4 ARGS render nowhere.vdb -o nowhere/out.exr
    STDERR "deltasplat: nowhere/out.exr: cannot be written: there is no folder nowhere")
foreach(file full.exr full.png)
    deltasplat_cli_test(output.${file} EXIT 4 ARGS render ${cube} -o ${file}
        STDERR "deltasplat: ${file}: cannot be written: No space left on device")
endforeach()
deltasplat_cli_test(output.stats_full EXIT 4 ARGS render ${cube} -o out.exr --stats full.json
    STDERR "deltasplat: full.json: cannot be written: No space left on device" CREATES out.exr)
deltasplat_cli_test(output.stats_no_folder EXIT 4
    ARGS render ${cube} -o out.exr --stats nowhere/stats.json
    STDERR "deltasplat: nowhere/stats.json: cannot be written: there is no folder nowhere")
deltasplat_cli_test(output.synth_no_folder EXIT 4 ARGS synth cloud nowhere/out.vdb
    STDERR "deltasplat: nowhere/out.vdb: cannot be written: there is no folder nowhere")
foreach(file full.raw full.vdb)
    deltasplat_cli_test(output.${file} EXIT 4 ARGS synth cloud ${file}
        STDERR "deltasplat: ${file}: cannot be written: No space left on device")
endforeach()

# What is written, and only that.
foreach(file out.exr out.png OUT.EXR out.tif)
    deltasplat_cli_test(output.fine.${file} ARGS render ball.vdb -o ${file} CREATES ${file})
endforeach()
deltasplat_cli_test(output.fine.deep CREATES out.exr stats.json
    ARGS render ball.vdb -o out.exr --deep --deep-slices 3 --float --stats stats.json)
deltasplat_cli_test(output.deep_verbose CREATES out.exr ARGS render ball.vdb -o out.exr --deep -v
    STDERR_MATCHES "code book .*method auto: .*[0-9]+ samples, at most 2 in a pixel.*--distance=7 .*")
# Of options given twice the last counts.
deltasplat_cli_test(output.twice CREATES b.png ARGS render ball.vdb -o a.png -o b.png)
deltasplat_cli_test(output.preview_verbose CREATES out.png
    ARGS render ball.vdb -o out.png --progressive -v
    STDERR_MATCHES "code book .*total [0-9.]*.preview: [0-9.]* seconds before.camera: .*")
deltasplat_cli_test(output.deep_no_folder EXIT 4 ARGS render ball.vdb -o nowhere/out.exr --deep
    STDERR "deltasplat: nowhere/out.exr: cannot be written: there is no folder nowhere")
deltasplat_cli_test(output.deep_full EXIT 4 ARGS render ${cube} -o full.exr --deep
    STDERR "deltasplat: full.exr: cannot be written: No space left on device")
deltasplat_cli_test(output.fine.bits ARGS render ball.vdb -o out.png --bits 16 CREATES out.png)
deltasplat_cli_test(output.fine.tif_bits ARGS render ball.vdb -o out.tiff --bits 16 CREATES out.tiff)
deltasplat_cli_test(output.fine.jpg CREATES out.jpg
    ARGS render ball.vdb -o out.jpg --background 1,1,1 --axes)
deltasplat_cli_test(output.fine.jpg_radiograph CREATES out.jpeg
    ARGS render ball.vdb -o out.jpeg --drr -q -q)
# What is clear becomes black, which is said, once.
foreach(background "" "--background=0,0,1,0.5")
    string(MAKE_C_IDENTIFIER "jpg_clear${background}" test)
    deltasplat_cli_test(output.${test} CREATES out.jpg ARGS render ball.vdb -o out.jpg ${background}
        STDERR "deltasplat: warning: out.jpg: a .jpg has no alpha, so what is clear is black; --background gives it another colour")
endforeach()
# Light that is clipped is told of, with what helps; as it is, none is.
set(clipped "--exposure darkens all, --tone filmic rolls highlights off, an .exr keeps them")
deltasplat_cli_test(output.clipped CREATES out.jpg
    ARGS render ball.vdb -o out.jpg --background 0.25,0.5,0.3 --exposure 2
    STDERR "deltasplat: warning: out.jpg: 100 % of the pixels are brighter than white, and clipped: ${clipped}")
deltasplat_cli_test(output.clipped_alpha CREATES out.png
    ARGS render ball.vdb -o out.png --exposure 1
    STDERR_MATCHES "^deltasplat: warning: out.png: [0-9.]+ % of the pixels that are not clear are brighter than their alpha, and clipped: ${clipped}\n?$")
deltasplat_cli_test(output.not_clipped CREATES out.png
    ARGS render ball.vdb -o out.png --background 1,1,1 --exposure 0)
deltasplat_cli_test(output.not_clipped_darker CREATES out.png
    ARGS render ball.vdb -o out.png --background 8,8,8 --exposure=-3)
deltasplat_cli_test(output.not_clipped_filmic CREATES out.png
    ARGS render ball.vdb -o out.png --exposure 5 --tone filmic)
deltasplat_cli_test(output.not_clipped_exr CREATES out.exr
    ARGS render ball.vdb -o out.exr --background 8,8,8)
deltasplat_cli_test(output.fine.stats CREATES out.exr stats.json
    ARGS render ball.vdb -o out.exr --float --stats stats.json --background 0.1,0.2,0.3,0.5)
deltasplat_cli_test(output.fine.fsync ARGS render ball.vdb -o out.exr --fsync CREATES out.exr)
deltasplat_cli_test(output.fine.verbose CREATES out.exr ARGS render ball.vdb -o out.exr -v
    STDERR_MATCHES "code book .*method auto: .* stamps.*slices along z.*seconds: read .*")
# A tolerance says what it may do to the picture.
deltasplat_cli_test(output.tolerance CREATES out.exr ARGS render ${cube} -o out.exr --tolerance 0.02 --method delta
    STDERR_MATCHES "tolerance 0.02 of the colour: error of a pixel at most, scene-linear and premultiplied: color 0.0[0-9]*, alpha 0.031[0-9]*")
# What is wrong of alpha is wrong of the background behind it.
deltasplat_cli_test(output.tolerance_background CREATES out.exr
    ARGS render ${cube} -o out.exr --tolerance 0.02 --method delta --background 8,0,0,0.5
    STDERR_MATCHES "tolerance .*premultiplied: color 0.188, alpha 0.0157")
deltasplat_cli_test(output.tolerance_value CREATES out.exr
    ARGS render ${cube} -o out.exr --tolerance-value 2 --method delta
    STDERR "tolerance 2 data units: error of a pixel at most, scene-linear and premultiplied: unknown")
# Where it takes longer than it saves it is left out, which is said, however wide footprints are.
deltasplat_cli_test(output.tolerance_auto CREATES out.exr
    ARGS render ${cube} -o out.exr --tolerance 0.02
    STDERR "deltasplat: warning: --tolerance: left out by --method auto, for holding values takes longer than it saves; --method delta holds them")
deltasplat_cli_test(output.tolerance_none CREATES out.exr
    ARGS render ${cube} -o out.exr --tolerance 0)
deltasplat_cli_test(output.tolerance_sigma CREATES out.exr
    ARGS render ${cube} -o out.exr --tolerance 0.02 --sigma 1
    STDERR_MATCHES "deltasplat: warning: --tolerance: left out by --method auto, .*")
deltasplat_cli_test(output.tolerance_quiet CREATES out.exr
    ARGS render ${cube} -o out.exr --tolerance 0.02 --method delta -q)
deltasplat_cli_test(output.fine.synth ARGS synth slab out.vdb CREATES out.vdb)
deltasplat_cli_test(output.json ARGS info ball.vdb --json -q STDOUT_MATCHES "\"comparability\": 0")
