# What `diff` says, and its exit codes: 0 same, 1 warning, 2 different, 4 not to be compared.
set(cube cube_8x8x8_uint8.raw)
set(changed changed_8x8x8_uint8.raw)

function(deltasplat_diff name exit stdout)
    deltasplat_cli_test(diff.${name} EXIT ${exit} STDOUT_MATCHES "${stdout}" ARGS diff ${ARGN})
endfunction()

deltasplat_cli_test(help_diff ARGS diff --help
    STDOUT_MATCHES "--fail A.*default 0.*Examples:.*deltasplat diff.*deltasplat diff.*Exit codes:")

deltasplat_diff(same 0 "^Comparing \"ball.vdb\" and \"ball.vdb\"
  grid          density
  transform     equal
  type          float
  class         fog volume
  background    0
  active        925 voxels
  Mean error = 0
  RMS error = 0
  Max error = 0
  0 voxels [(]0%[)] over 0
  0 voxels [(]0%[)] over 0
PASS$" ball.vdb ball.vdb)
# 3 at one of 512 voxels: mean 3/512, root of the mean square 3/sqrt(512).
set(one "  Mean error = 0.005859375
  RMS error = 0.1325825214724[0-9]*
  Max error = 3 @ [(]5,1,1[)], in the world [(]5,1,2[)]; values are 77 vs 80
")
deltasplat_diff(different 2 "${one}  1 voxel [(]0.195%[)] over 0
  1 voxel [(]0.195%[)] over 0
FAILURE$" ${cube} ${changed} --spacing 1,1,2)
deltasplat_diff(warning 1 "${one}  1 voxel [(]0.195%[)] over 2.5
  0 voxels [(]0%[)] over 3
WARNING$" ${cube} ${changed} --spacing 1,1,2 -fail 3 -warn 2.5)
deltasplat_diff(one_dash_equals 0 "over 3
  0 voxels .* over 3
PASS" ${cube} ${changed} -fail=3 -warn=3)
deltasplat_diff(two_dashes 1 "WARNING" ${cube} ${changed} --fail 3)
deltasplat_diff(percent 1 "WARNING" ${cube} ${changed} -failpercent 0.2)
deltasplat_diff(percent_both 0 "PASS" ${cube} ${changed} -failpercent 0.2 -warnpercent 0.2)
deltasplat_diff(percent_too_small 2 "FAILURE" ${cube} ${changed} -failpercent 0.19)
deltasplat_diff(hard_fail 2 "FAILURE" ${cube} ${changed} -failpercent 1 -hardfail 2.9)
deltasplat_diff(hard_fail_not_over 1 "WARNING" ${cube} ${changed} -failpercent 1 -hardfail 3)
deltasplat_diff(hard_warn 1 "WARNING" ${cube} ${changed} -fail 5 -warn 5 -hardwarn 2)
deltasplat_diff(raw_options 2 "Max error = 3 @ [(]5,1,1[)]" plain.raw changed.raw
    --dims 8x8x8 --type uint8)
deltasplat_diff(sizes 2 "256 in one of them only
  dims          A has 8 x 8 x 8, B has 8 x 8 x 4.*FAILURE" ${cube} half_8x8x4_uint8.raw
    --ignore-active --fail 255)

# Each way in which two grids can differ.
deltasplat_diff(grid_name 0 "grid          A has density, B has smoke.*PASS" ball.vdb ball_named.vdb)
deltasplat_diff(type 0 "type          A has float, B has double.*PASS" ball.vdb ball_double.vdb)
deltasplat_diff(class 0 "class         A has fog volume, B has level set.*PASS"
    ball.vdb ball_class.vdb)
deltasplat_diff(background 2 "background    A has 0, B has -1; they differ by 1.*FAILURE"
    ball.vdb ball_background.vdb)
deltasplat_diff(background_over 2 "Max error = 0.*FAILURE"
    ball.vdb ball_background.vdb --fail 0.9 --failpercent 100)
deltasplat_diff(background_within 0 "PASS" ball.vdb ball_background.vdb --fail 1 --warn 1)
deltasplat_diff(active 2
    "A has 925 voxels, B has 926 voxels; 1 in one of them only.*Max error = 0.*FAILURE"
    ball.vdb ball_active.vdb --fail 1 --failpercent 100)
deltasplat_diff(active_ignored 0 "1 in one of them only.*PASS"
    ball.vdb ball_active.vdb --ignore-active)
deltasplat_diff(moved 2 "transform     different, up to 0.5 voxels apart.*Max error = 0.*FAILURE"
    ball.vdb ball_moved.vdb)
deltasplat_diff(moved_within 0 "equal within rounding, up to 0.5 voxels apart.*PASS"
    ball.vdb ball_moved.vdb --shift 0.5)
deltasplat_diff(elsewhere 0
    "transform     equal; B's voxel [(]0,0,0[)] is A's [(]-5,4,-3[)].*active +925 voxels.*PASS"
    ball.vdb ball_elsewhere.vdb)
deltasplat_diff(elsewhere_json 2
    "\"active_mismatch\": 1,.*\"transform_equal\": true,.*\"offset\": .[^]]*5,[^]]*-4,[^]]*3[^]]*.,"
    ball_elsewhere.vdb ball_active.vdb --json)
add_test(NAME cli.diff.converted COMMAND bash ${CMAKE_CURRENT_LIST_DIR}/scripts/converted.sh
    $<TARGET_FILE:deltasplat_tool> ${CMAKE_CURRENT_BINARY_DIR}/cli/converted ${DELTASPLAT_FIXTURES})
set_tests_properties(cli.diff.converted PROPERTIES LABELS cli TIMEOUT 120
                     FIXTURES_REQUIRED cli_files)
deltasplat_diff(dense_and_sparse 2 "background    A has none, B has 0.*FAILURE" ${cube} ball.vdb)

# Several grids.
deltasplat_diff(grids 2 "grid          density.*Max error = 0
.*grid          heat.*Max error = 0.25 @ [(]1,2,3[)].*only in B     smoke
  not compared  velocity [(]vec3s[)]
FAILURE" two.vdb three.vdb)
deltasplat_cli_test(diff.grids_and_none EXIT 2 ARGS diff three.vdb ${cube}
    STDERR "deltasplat: warning: three.vdb: reading grid \"density\" of 3 scalar grids (--grid chooses another)"
    STDOUT_MATCHES "only in A     heat
  only in A     smoke
  not compared  velocity [(]vec3s[)]
FAILURE")
deltasplat_diff(grids_reversed 2 "only in A     smoke" three.vdb two.vdb)
deltasplat_diff(missing_in_b 2 "grid          density.*Max error = 0.*only in A     heat
FAILURE" two.vdb ball.vdb)
deltasplat_diff(missing_ignored 0 "only in A     heat
PASS" two.vdb ball.vdb --ignore-missing)
deltasplat_diff(others_not_compared 2 "Max error = 0.*not compared  velocity [(]vec3s[)]
FAILURE" mixed.vdb mixed.vdb)
deltasplat_diff(others_ignored 0 "not compared  velocity [(]vec3s[)]
PASS" mixed.vdb mixed.vdb --ignore-missing)
deltasplat_diff(others_not_asked_for 0 "grid          density.*PASS" mixed.vdb mixed.vdb
    --grid density)
# Undefined distances do not keep densities from being compared.
deltasplat_diff(cache 2 "grid          flags.*grid          density.*not compared  phi_obstacle [(]NaN or infinite values[)]
FAILURE" cache.vdb cache.vdb)
deltasplat_diff(cache_ignored 0 "PASS" cache.vdb cache.vdb --ignore-missing)
deltasplat_diff(other_type 2 "grid          heat.*not compared  density [(]uint8[)]
FAILURE" other_type.vdb other_type.vdb)
deltasplat_diff(frustum_first 2
    "grid          heat.*not compared  density [(]a NonlinearFrustumMap transform[)]
FAILURE" frustum_first.vdb frustum_first.vdb)
deltasplat_diff(unnamed 0 "grid          density.*PASS" unnamed.vdb unnamed.vdb)
# Two that are both stored as "density".
deltasplat_diff(name_twice 0 "grid          density\\[0\\].*grid          density\\[1\\].*PASS"
    same_names.vdb same_names.vdb)
deltasplat_diff(one_grid 0 "grid          density.*PASS" two.vdb three.vdb --grid density)
deltasplat_diff(other_grid 2 "grid          heat.*FAILURE" two.vdb three.vdb --grid heat)
deltasplat_diff(no_common_grid 2 "only in A     density
  only in A     heat
  only in B     smoke
FAILURE" two.vdb ball_named.vdb)

# The report as JSON, or none.
deltasplat_diff(json 2 "\"over\": 1,.*\"active_mismatch\": 0,.*\"transform_equal\": true,.*\"equal\": false,.*\"result\": \"FAILURE\""
    ${cube} ${changed} --json)
deltasplat_diff(json_same 0 "\"max_at\": null,.*\"equal\": true" ${cube} ${cube} --json -q)
deltasplat_diff(json_not_compared 2 "\"equal\": false,.*\"not_compared\": .[^]]*velocity"
    mixed.vdb mixed.vdb --json)
deltasplat_diff(json_only_in_one 2 "\"equal\": false,.*\"only_in_b\": .[^]]*\"smoke\""
    ball.vdb three.vdb --json)
deltasplat_diff(quiet 2 "^$" ${cube} ${changed} -q)
deltasplat_diff(quiet_same 0 "^$" ${cube} ${cube} -q)

# What cannot be compared.
function(deltasplat_diff_refusal name message)
    deltasplat_cli_test(diff.refused.${name} EXIT 4 STDERR "deltasplat: ${message}"
                        STDOUT_MATCHES "^$" ARGS diff ${ARGN})
endfunction()
# Of a grid that is found out while it is compared to need another look.
deltasplat_diff_refusal(not_finite "nan.vdb: grid \"density\": got 2 NaN or infinite active values, the first at (1, 2, 3); expected finite values (--nan VALUE replaces them)" nan.vdb nan.vdb)
deltasplat_cli_test(diff.warnings_of_both ARGS diff empty.vdb empty.vdb
    STDERR "deltasplat: warning: empty.vdb: grid \"density\": no active voxels
deltasplat: warning: empty.vdb: grid \"density\": no active voxels" STDOUT_MATCHES "PASS")
deltasplat_diff_refusal(missing "nowhere.vdb: got no such file; expected a readable file"
    ball.vdb nowhere.vdb)
deltasplat_diff_refusal(unreadable "cut_8x8x8_uint8.raw: got 500 bytes; expected 512 (8x8x8 uint8)"
    ${cube} cut_8x8x8_uint8.raw)
deltasplat_diff_refusal(usage "--fail: got -1; expected a finite number of at least 0"
    ${cube} ${cube} -fail -1)
deltasplat_diff_refusal(percent
    "--failpercent: got 101; expected a finite number from 0 to 100" ${cube} ${cube}
    --failpercent 101)
deltasplat_diff_refusal(unknown_option "Unknown option '--fale'. Did you mean '--fail'?"
    ${cube} ${cube} --fale 1)
deltasplat_diff_refusal(one_file "B: got nothing; expected FILE (see 'deltasplat diff --help')"
    ${cube})
deltasplat_diff_refusal(three_files "Unexpected argument 'two.vdb'; see 'deltasplat diff --help'"
    ball.vdb ball.vdb two.vdb)
deltasplat_diff_refusal(no_dims
    "plain.raw: got no dimensions; expected --dims XxYxZ and --type TYPE, or a name such as volume_256x256x128_uint8.raw"
    plain.raw plain.raw --type uint8)
deltasplat_diff_refusal(no_such_grid
    "two.vdb: got no grid \"smoke\"; expected one of density (float), heat (float)"
    two.vdb three.vdb --grid smoke)
deltasplat_diff_refusal(vectors
    "vectors.vdb: got only velocity (vec3s); expected a scalar grid (float, double, half, int32, int64, bool or mask)"
    ball.vdb vectors.vdb)

# Of files that name no place, that is said where it counts.
deltasplat_diff(no_place 2
    "transform     equal; B's voxel [(]0,0,0[)] is A's [(]2,0,0[)] [(]A's is origin 0,0,0 and spacing 1,1,1, as of files that name none; --origin and --spacing name them[)]"
    ${cube} moved.nrrd)
