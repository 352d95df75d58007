# What `info` tells beyond one healthy file: the rest beside what cannot be read, stamps, plots.
set(cube cube_8x8x8_uint8.raw)

# A file that cannot be read does not keep the others from being told.
deltasplat_cli_test(info.others_are_told EXIT 3 ARGS info nowhere.vdb ${cube}
    STDERR "deltasplat: nowhere.vdb: got no such file; expected a readable file"
    STDOUT_MATCHES "^${cube}.*grid +cube_8x8x8_uint8")
deltasplat_cli_test(info.all_errors_are_shown EXIT 3
    ARGS info garbage.vdb ball.vdb one_bad.vdb cut_8x8x8_uint8.raw ${cube}
    STDERR "deltasplat: garbage.vdb: got no OpenVDB data; expected a .vdb file
deltasplat: one_bad.vdb: grid \"density\": got 2 NaN or infinite active values, the first at (1, 2, 3); expected finite values (--nan VALUE replaces them)
deltasplat: cut_8x8x8_uint8.raw: got 500 bytes; expected 512 (8x8x8 uint8)"
    STDOUT_MATCHES "^ball.vdb.*one_bad.vdb.*grid +smoke.*${cube}")
deltasplat_cli_test(info.errors_of_usage_too EXIT 2 ARGS info ball.vdb plain.raw
    STDERR "deltasplat: plain.raw: got no dimensions; expected --dims XxYxZ and --type TYPE, or a name such as volume_256x256x128_uint8.raw"
    STDOUT_MATCHES "^ball.vdb")
deltasplat_cli_test(info.others_in_json EXIT 3 ARGS info nowhere.vdb ball.vdb --json
    STDERR "deltasplat: nowhere.vdb: got no such file; expected a readable file"
    STDOUT_MATCHES "^[{].*\"file\": \"ball.vdb\".*[}]$")

# The cube's codes are 0..96 in turn, the ball's 925 voxels hold 0.5.
deltasplat_cli_test(info.raw ARGS info ${cube}
    STDOUT_MATCHES "percentiles +1 %: 0, 50 %: 4[0-9], 99 %: 9[0-9].*background +none that is obvious.*visible: all voxels.*along z +512 +512 .*histogram")
deltasplat_cli_test(info.vdb ARGS info ball.vdb
    STDOUT_MATCHES "background +0.*visible: active voxels other than the background 0.*along x +2197 +925 .*ten times as many[^#]*0.5 +100.0000 %  ################################################$")
deltasplat_cli_test(info.tf ARGS info ball.vdb --tf tf_good.json
    STDOUT_MATCHES "visible: not clear under tf_good.json")
deltasplat_cli_test(info.tf_missing EXIT 3 ARGS info ball.vdb --tf tf_missing.json
    STDERR "deltasplat: tf_missing.json: got no such file; expected a transfer function (ParaView's JSON)")

# Where it lies, and what its axes mean.
deltasplat_cli_test(info.place ARGS info ball.vdb
    STDOUT_MATCHES "world box +[(]-6, -6, -6[)] to [(]6, 6, 6[)]
  origin +[(]0, 0, 0[)]
  directions +i to [+]x, j to [+]y, k to [+]z
  front view +target [(]0, 0, 0[)], frame width 12
")
deltasplat_cli_test(info.patient ARGS info patient.vdb
    STDOUT_MATCHES "space +LPS: x to the patient's left, y to the back, z to the head
  directions +i to the patient's left, j to the back, k to the head
")
deltasplat_cli_test(info.oblique ARGS info tilted.vdb
    STDOUT_MATCHES "space +RAS: x to the patient's right, y to the front, z to the head
  directions +i to the patient's left, j 30.0 degrees off the front, k 30.0 degrees off the head
")

# Only headers: a line for each grid.
deltasplat_cli_test(info.list ARGS info --list cache.vdb three.vdb empty.vdb ${cube}
    STDOUT_MATCHES "^cache.vdb
  phi_obstacle  float  level set   [(]0, 0, 0[)] to [(]11, 11, 11[)]
  flags         int32  unknown     [(]0, 0, 0[)] to [(]11, 11, 11[)]
  shadow        float  fog volume  [(]0, 0, 0[)] to [(]11, 11, 11[)]
  speed         float  unknown     [(]0, 0, 0[)] to [(]11, 11, 11[)]
  density       float  fog volume  [(]-6, -6, -6[)] to [(]6, 6, 6[)]  default
three.vdb
  density +float +fog volume +[(]-6, -6, -6[)] to [(]6, 6, 6[)] +default
.*  velocity  vec3s  -           [(]1, 2, 3[)] to [(]1, 2, 3[)]     not read
empty.vdb
  density  float  fog volume  empty  default
${cube}
  cube_8x8x8_uint8  uint8  -  [(]0, 0, 0[)] to [(]7, 7, 7[)]  default$")
deltasplat_cli_test(info.list_points ARGS info --list points.vdb
    STDOUT_MATCHES "  points .* not read$")
deltasplat_cli_test(info.list_others EXIT 3 ARGS info --list nowhere.vdb ball.vdb
    STDERR "deltasplat: nowhere.vdb: got no such file; expected a readable file"
    STDOUT_MATCHES "^ball.vdb
  density")

# Plots.
foreach(file plot.png plot.svg PLOT.SVG)
    deltasplat_cli_test(info.plot.${file} ARGS info ball.vdb --plot ${file} CREATES ${file}
        STDOUT_MATCHES "grid +density")
endforeach()
deltasplat_cli_test(info.plot.empty ARGS info empty.vdb -qq --plot plot.svg CREATES plot.svg)
deltasplat_cli_test(info.plot.of_the_others EXIT 3 CREATES plot.png
    ARGS info nowhere.vdb ball.vdb --plot plot.png
    STDERR "deltasplat: nowhere.vdb: got no such file; expected a readable file")
deltasplat_cli_test(info.plot.of_nothing EXIT 3 ARGS info nowhere.vdb --plot plot.png
    STDERR "deltasplat: nowhere.vdb: got no such file; expected a readable file")
deltasplat_cli_test(info.plot.many CREATES plot.svg
    ARGS info two.vdb two.vdb two.vdb two.vdb two.vdb two.vdb two.vdb two.vdb ball.vdb ball.vdb
         --plot plot.svg
    STDERR "deltasplat: warning: --plot: shows the first 16 grids only")
deltasplat_cli_test(info.plot.just_enough CREATES plot.svg
    ARGS info two.vdb two.vdb two.vdb two.vdb two.vdb two.vdb two.vdb two.vdb --plot plot.svg)
foreach(file plot.jpg plot plot.exr)
    string(REGEX MATCH "[.].*" extension ${file})
    deltasplat_cli_test(info.plot_format.${file} EXIT 2 ARGS info nowhere.vdb --plot ${file}
        STDERR "deltasplat: ${file}: got extension \"${extension}\"; expected .png or .svg")
endforeach()
deltasplat_cli_test(info.plot_no_folder EXIT 4 ARGS info nowhere.vdb --plot nowhere/plot.svg
    STDERR "deltasplat: nowhere/plot.svg: cannot be written: there is no folder nowhere")
foreach(file full.png full.svg)
    deltasplat_cli_test(info.plot_${file} EXIT 4 ARGS info ball.vdb --plot ${file}
        STDERR "deltasplat: ${file}: cannot be written: No space left on device"
        STDOUT_MATCHES "grid +density")
endforeach()

set(scripts ${CMAKE_CURRENT_LIST_DIR}/scripts)
set(scratch ${CMAKE_CURRENT_BINARY_DIR}/cli)
foreach(extension png svg)
    add_test(NAME cli.info.same_plot.${extension}
             COMMAND bash ${scripts}/same_plot.sh $<TARGET_FILE:deltasplat_tool>
                     ${scratch}/same_plot_${extension} ${extension})
    set_tests_properties(cli.info.same_plot.${extension} PROPERTIES LABELS cli TIMEOUT 120)
endforeach()
add_test(NAME cli.info.predicted_stamps
         COMMAND ${CMAKE_COMMAND} -DPROGRAM=$<TARGET_FILE:deltasplat_tool>
                 -DEXAMPLES=${PROJECT_SOURCE_DIR}/examples -DSCRATCH=${scratch}/predicted_stamps
                 -P ${scripts}/predicted_stamps.cmake)
set_tests_properties(cli.info.predicted_stamps PROPERTIES LABELS cli TIMEOUT 600)

# What a listing has no use for.
deltasplat_cli_test(info.list_without_plot ARGS info --list ball.vdb --plot plot.svg --tf tf_good.json
    STDERR "deltasplat: warning: --plot: has no effect with --list
deltasplat: warning: --tf: has no effect with --list"
    STDOUT_MATCHES "^ball.vdb")
# For people, sizes are as exact as floats; JSON has all digits.
deltasplat_cli_test(info.size_digits
    ARGS info cube_8x8x8_uint8.raw --spacing 0.9999999999999981,0.05000000074505806,0.123456789
    STDOUT_MATCHES "voxel size +1 x 0[.]05 x 0[.]12345679
")
deltasplat_cli_test(info.size_digits_json
    ARGS info cube_8x8x8_uint8.raw --json --spacing 0.9999999999999981,0.05000000074505806,0.123456789
    STDOUT_MATCHES "\"voxel_size\": [[][ \n]*0[.]9999999999999981,[ \n]*0[.]05000000074505806")

# Zeros have no sign.
foreach(format "" --json)
    deltasplat_cli_test(info.signed_zero${format} ARGS info signed_zero.nrrd ${format}
        STDOUT_MATCHES "^([^-]|-[^0]|-0[.][0-9]*[1-9])*$")
endforeach()
