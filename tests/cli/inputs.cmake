# Inputs that cannot be read or are invalid: exit code 3, whichever subcommand reads them.

# Declares that info and render refuse a file: name, message, file and options.
function(deltasplat_bad_input name message)
    deltasplat_cli_test(input.${name}.info EXIT 3 STDERR "deltasplat: ${message}" ARGS info ${ARGN})
    deltasplat_cli_test(input.${name}.render EXIT 3 STDERR "deltasplat: ${message}"
                        ARGS render ${ARGN} -o out.exr --stats stats.json)
endfunction()

deltasplat_bad_input(missing "nowhere.vdb: got no such file; expected a readable file" nowhere.vdb)
deltasplat_bad_input(missing_raw
    "nowhere_8x8x8_uint8.raw: got no such file; expected a readable file" nowhere_8x8x8_uint8.raw)
deltasplat_bad_input(folder
    "folder.exr: got a folder without DICOM files and images; expected a DICOM folder, a folder of images, or a file"
    folder.exr)
deltasplat_bad_input(format
    "tf_good.json: got extension \".json\"; expected .vdb, .raw, .npy, .nrrd, .nhdr, .mhd, .mha, .nii, .hdr, .img (all of these also with .gz), .dcm, .tif, .tiff, .png, .jpg, .jpeg, .bmp, .pgm or .exr" tf_good.json)

deltasplat_bad_input(cut_raw
    "cut_8x8x8_uint8.raw: got 500 bytes; expected 512 (8x8x8 uint8)" cut_8x8x8_uint8.raw)
deltasplat_bad_input(long_raw
    "long_8x8x8_uint8.raw: got 516 bytes; expected 512 (8x8x8 uint8)" long_8x8x8_uint8.raw)
deltasplat_bad_input(other_dims
    "plain.raw: got 512 bytes; expected 448 (8x8x7 uint8)" plain.raw --dims 8x8x7 --type uint8)
deltasplat_bad_input(other_type
    "plain.raw: got 512 bytes; expected 1024 (8x8x8 uint16)" plain.raw --dims 8x8x8 --type uint16)
deltasplat_bad_input(header
    "plain.raw: got 512 bytes; expected 513 (1 skipped + 8x8x8 uint8)"
    plain.raw --dims 8x8x8 --type uint8 --skip-bytes 1)
deltasplat_bad_input(no_gzip
    "garbage_8x8x8_uint8.raw.gz: got no gzip stream; expected a gzip file"
    garbage_8x8x8_uint8.raw.gz)
deltasplat_bad_input(nan_raw
    "nan_4x4x4_float32.raw: got 2 NaN or infinite values, the first at (1, 2, 3); expected finite values (--nan VALUE replaces them)"
    nan_4x4x4_float32.raw)

set(scalar "a scalar grid (float, double, half, int32, int64, bool or mask)")
deltasplat_bad_input(garbage "garbage.vdb: got no OpenVDB data; expected a .vdb file" garbage.vdb)
deltasplat_bad_input(no_bytes "zero.vdb: got no OpenVDB data; expected a .vdb file" zero.vdb)
foreach(file cut head_only)
    foreach(subcommand "info" "render;-o;out.exr")
        list(GET subcommand 0 word)
        deltasplat_cli_test(input.${file}.${word} EXIT 3 ARGS ${subcommand} ${file}.vdb
            STDERR_MATCHES "deltasplat: ${file}.vdb: got [0-9]+ bytes; expected at least [0-9 +]+ .a .vdb file that is cut short or corrupt.")
    endforeach()
endforeach()
deltasplat_bad_input(no_grids "none.vdb: got no grids; expected ${scalar}" none.vdb)
deltasplat_bad_input(only_vectors
    "vectors.vdb: got only velocity (vec3s); expected ${scalar}" vectors.vdb)
deltasplat_bad_input(only_points
    "points.vdb: got only points (ptdataidx32); expected ${scalar}" points.vdb)
deltasplat_bad_input(frustum
    "frustum.vdb: grid \"density\": got a NonlinearFrustumMap transform; expected a linear one (no frustum)"
    frustum.vdb)
deltasplat_bad_input(nan_vdb
    "nan.vdb: grid \"density\": got 2 NaN or infinite active values, the first at (1, 2, 3); expected finite values (--nan VALUE replaces them)"
    nan.vdb)
deltasplat_bad_input(grid_name
    "two.vdb: got no grid \"smoke\"; expected one of density (float), heat (float)"
    two.vdb --grid smoke)
deltasplat_bad_input(grid_type
    "mixed.vdb: got grid \"velocity\" of type vec3s; expected ${scalar}, or a part of it such as velocity.x"
    mixed.vdb --grid velocity)

foreach(file nan.vdb nan_4x4x4_float32.raw)
    deltasplat_cli_test(input.nan_beyond_float.${file} EXIT 2 ARGS info ${file} --nan 1e300
        STDERR "deltasplat: --nan: got 1e+300; expected a value that is finite as float")
endforeach()

# One grid that is invalid does not keep the others from being told.
deltasplat_cli_test(input.one_bad_grid EXIT 3 ARGS info one_bad.vdb
    STDERR "deltasplat: one_bad.vdb: grid \"density\": got 2 NaN or infinite active values, the first at (1, 2, 3); expected finite values (--nan VALUE replaces them)"
    STDOUT_MATCHES "grid +smoke.*not read +velocity .vec3s.")

# What looks alike and is fine.
deltasplat_cli_test(input.fine.empty ARGS render empty.vdb -o out.exr CREATES out.exr
    STDERR "deltasplat: warning: empty.vdb: grid \"density\": no active voxels")
deltasplat_cli_test(input.fine.empty_quiet ARGS render empty.vdb -o out.exr -qq CREATES out.exr)
deltasplat_cli_test(input.fine.empty_no_progress ARGS render empty.vdb -o out.exr -q CREATES out.exr
    STDERR "deltasplat: warning: empty.vdb: grid \"density\": no active voxels")
deltasplat_cli_test(input.fine.nan ARGS render nan.vdb -o out.exr --nan 0 CREATES out.exr
    STDERR "deltasplat: warning: nan.vdb: grid \"density\": 2 NaN or infinite active values replaced by 0")
deltasplat_cli_test(input.fine.mixed ARGS render mixed.vdb -o out.exr CREATES out.exr)
deltasplat_cli_test(input.fine.second_grid ARGS info two.vdb --grid heat STDOUT_MATCHES "grid +heat")

# The grid that is meant and cannot be read is never replaced by the next.
set(other_type "other_type.vdb: got grid \"density\" of type uint8; expected ${scalar}")
set(frustum_first
    "warning: frustum_first.vdb: reading grid \"density\" of 2 scalar grids (--grid chooses another)
deltasplat: frustum_first.vdb: grid \"density\": got a NonlinearFrustumMap transform; expected a linear one (no frustum)")
foreach(kind other_type frustum_first)
    deltasplat_cli_test(input.kind.${kind}.render EXIT 3 STDERR "deltasplat: ${${kind}}"
                        ARGS render ${kind}.vdb -o out.exr)
    deltasplat_cli_test(input.kind.${kind}.npy EXIT 3 STDERR "deltasplat: ${${kind}}"
                        ARGS convert ${kind}.vdb out.npy)
    deltasplat_cli_test(input.kind.${kind}.asked_for ARGS render ${kind}.vdb -o out.exr --grid heat
                        CREATES out.exr)
endforeach()
deltasplat_cli_test(input.kind.other_type.info ARGS info other_type.vdb
    STDOUT_MATCHES "grid +heat.*not read +density .uint8.")
deltasplat_cli_test(input.kind.frustum_first.info EXIT 3
    STDERR "deltasplat: frustum_first.vdb: grid \"density\": got a NonlinearFrustumMap transform; expected a linear one (no frustum)"
    ARGS info frustum_first.vdb STDOUT_MATCHES "grid +heat")
deltasplat_cli_test(input.kind.list ARGS info --list other_type.vdb frustum_first.vdb
    STDOUT_MATCHES "density +uint8 .* not read: type uint8
  heat .*density +float .* not read: a NonlinearFrustumMap transform
  heat ")
deltasplat_cli_test(input.kind.batch EXIT 3 ARGS render "other_*.vdb" -o "out/{grid}.exr"
    STDERR_MATCHES ".*density.*of type uint8.*" CREATES out)
deltasplat_cli_test(input.fine.long_name ARGS info --list long_name.vdb
    STDOUT_MATCHES "n  float  fog volume  [^
]*
  d                                                 float  fog volume")
deltasplat_cli_test(input.many EXIT 3 ARGS render many.vdb -o out.exr --grid smoke
    STDERR_MATCHES "deltasplat: many.vdb: got no grid .smoke.; expected one of density .float., v0 .*, v30 .vec3s. and 19 others")
deltasplat_cli_test(input.fine.plain ARGS info plain.raw --dims 8x4x8 --type uint16 --endian big
    STDOUT_MATCHES "dims +8 x 4 x 8")
deltasplat_cli_test(input.fine.two_files ARGS info ball.vdb cube_8x8x8_uint8.raw
    STDOUT_MATCHES "ball.vdb.*cube_8x8x8_uint8.raw.*uint8")

# Transfer functions: file, line, what was expected.
function(deltasplat_bad_transfer_function name message)
    deltasplat_cli_test(input.tf.${name} EXIT 3 STDERR "deltasplat: ${message}"
                        ARGS render cube_8x8x8_uint8.raw -o out.exr --tf tf_${name}.json)
endfunction()
deltasplat_bad_transfer_function(missing "tf_missing.json: got no such file; expected a transfer function (ParaView's JSON)")
deltasplat_cli_test(input.tf.device EXIT 3 ARGS render cube_8x8x8_uint8.raw -o out.exr --tf /dev/zero
    STDERR "deltasplat: /dev/zero: got no file that can be read; expected a transfer function (ParaView's JSON)")
deltasplat_cli_test(input.tf.no_json EXIT 3
    ARGS render cube_8x8x8_uint8.raw -o out.exr --tf tf_no_json.json
    STDERR_MATCHES "deltasplat: tf_no_json.json:5: got .*; expected valid JSON")
deltasplat_bad_transfer_function(no_colors "tf_no_colors.json:2: got no RGBPoints; expected RGBPoints with groups of four numbers (x, red, green, blue)")
deltasplat_bad_transfer_function(odd_count "tf_odd_count.json:4: got 3 numbers; expected RGBPoints with groups of four numbers (x, red, green, blue)")
deltasplat_bad_transfer_function(word "tf_word.json:5: got \"much\"; expected a number in Points")
deltasplat_bad_transfer_function(opacity "tf_opacity.json:5: got 1.5; expected a number within 0..1 in Points")
deltasplat_bad_transfer_function(falling "tf_falling.json:4: got 0; expected x not below the 1 before it in RGBPoints")
deltasplat_cli_test(input.tf.range ARGS render cube_8x8x8_uint8.raw -o out.exr --tf tf_good.json
    --range 0,1 CREATES out.exr
    STDERR "deltasplat: warning: --range: has no effect on a transfer function that is not normalized")
deltasplat_cli_test(render.join.of_whole_voxels ARGS render ${cube} -o j.png --join 8 --between 0 CREATES j.png
    STDERR "deltasplat: warning: --join: has no effect with --between")
deltasplat_cli_test(render.join.of_held_voxels ARGS render ${cube} -o j.png --join 8 --tolerance 0.1 --method delta CREATES j.png
    STDERR "deltasplat: warning: --join: has no effect with a tolerance
tolerance 0.1 of the colour: error of a pixel at most, scene-linear and premultiplied: color 0.313, alpha 0.157")
deltasplat_cli_test(render.join.of_exact_voxels ARGS render ${cube} -o j.png --join 8 --tolerance 0 CREATES j.png)
deltasplat_cli_test(input.range.ramp ARGS render cube_8x8x8_uint8.raw -o out.exr --range 0,1
    CREATES out.exr)
# One of several in a file, tables of labels, presets.
deltasplat_cli_test(input.tf.second ARGS render cube_8x8x8_uint8.raw -o out.exr --tf tf_several.json:second
    CREATES out.exr)
deltasplat_cli_test(input.tf.third EXIT 3
    ARGS render cube_8x8x8_uint8.raw -o out.exr --tf tf_several.json:third
    STDERR "deltasplat: tf_several.json: got no transfer function \"third\"; expected one of those it has: first, second")
deltasplat_cli_test(input.tf.no_name EXIT 2 ARGS render cube_8x8x8_uint8.raw -o out.exr --tf tf_several.json:
    STDERR "deltasplat: --tf: got tf_several.json:; expected a name behind the colon")
deltasplat_cli_test(input.tf.labels_by_name EXIT 2
    ARGS render cube_8x8x8_uint8.raw -o out.exr --tf labels.ctbl:bone
    STDERR "deltasplat: --tf: got labels.ctbl:bone; expected labels.ctbl alone, a table of labels, which holds no transfer functions with names")
deltasplat_cli_test(input.tf.labels ARGS render cube_8x8x8_uint8.raw -o out.exr --tf labels.ctbl
    CREATES out.exr
    STDERR "deltasplat: warning: --tf: labels 3, 4, 5, 6, 7 and 89 more of the volume are not in the table, and not shown")
deltasplat_cli_test(input.tf.preset ARGS render cube_8x8x8_uint8.raw -o out.exr --tf viridis CREATES out.exr)
deltasplat_cli_test(input.tf.preset_of_info ARGS info ball.vdb --tf mr
    STDOUT_MATCHES "visible: not clear under mr")
deltasplat_cli_test(input.tf.no_preset EXIT 2 ARGS render cube_8x8x8_uint8.raw -o out.exr --tf viridi
    STDERR_MATCHES "deltasplat: --tf: got viridi; expected a file, or one of grey, .*coolwarm[.] Did you mean 'viridis'[?]")
deltasplat_cli_test(input.tf.no_suggestion EXIT 2 ARGS render cube_8x8x8_uint8.raw -o out.exr --tf aquarium
    STDERR_MATCHES "deltasplat: --tf: got aquarium; expected a file, or one of grey, .*coolwarm")
deltasplat_cli_test(input.tf.no_hounsfield ARGS render cube_8x8x8_uint8.raw -o out.exr --tf ct-bone
    CREATES out.exr
    STDERR_MATCHES "deltasplat: warning: --tf: ct-bone is for Hounsfield units [(]air -1000, water 0[)]; values from .* to .* seem to be others.*picture: empty.*")
deltasplat_cli_test(input.tf.labels_of_wholes ARGS render ball.vdb -o out.exr --tf labels CREATES out.exr
    STDERR_MATCHES "deltasplat: warning: --tf: labels is for whole numbers, and values from .* to .* lie between, such as .*")
deltasplat_cli_test(input.tf.list ARGS render --list-tf STDOUT_MATCHES "grey .*ct-bone +Hounsfield units.*coolwarm")
deltasplat_cli_test(input.tf.list_whatever_else ARGS render missing.vdb -o out.png --list-tf
    STDOUT_MATCHES "grey .*coolwarm")
deltasplat_cli_test(input.tf.list_drawn ARGS render --list-tf presets.png CREATES presets.png)
deltasplat_cli_test(input.tf.list_drawn_of_bench ARGS bench --list-tf=presets.svg CREATES presets.svg)
deltasplat_cli_test(input.flag_before ARGS render -q --float cube_8x8x8_uint8.raw -o out.exr CREATES out.exr)
deltasplat_cli_test(input.tf.list_no_drawing EXIT 2 ARGS render --list-tf=presets.txt
    STDERR "deltasplat: presets.txt: got extension \".txt\"; expected .png or .svg")
# What shows nothing says why.
set(outside "picture: empty, for what can be seen of the volume lies outside of it, before the near plane, or is far smaller than a pixel; the volume lies in the world from 0,0,0 to 7,7,7")
deltasplat_cli_test(empty_picture.target ARGS render cube_8x8x8_uint8.raw -o out.png --target 100,0,0
    STDERR "deltasplat: warning: ${outside}" CREATES out.png)
deltasplat_cli_test(empty_picture.near
    ARGS render cube_8x8x8_uint8.raw -o out.png --projection perspective --near 1e6
    STDERR "deltasplat: warning: ${outside}" CREATES out.png)
deltasplat_cli_test(empty_picture.extinction
    ARGS render cube_8x8x8_uint8.raw -o out.png --extinction 0
    STDERR "deltasplat: warning: picture: empty, for transfer function and extinction show none of the values 0 to 96"
    CREATES out.png)
deltasplat_cli_test(empty_picture.gradient
    ARGS render cube_8x8x8_uint8.raw -o out.png --gradient-opacity 0:0,10000:0
    STDERR "deltasplat: warning: picture: empty, for transfer function and extinction show none of the values 0 to 96"
    CREATES out.png)
# From an eye, also where nothing of what is there is before it.
foreach(between 0 1)
    deltasplat_cli_test(empty_picture.eye_${between}
        ARGS render cube_8x8x8_uint8.raw -o out.png --projection perspective --eye 100,0,0 --direction 1,0,0
             --between ${between}
        STDERR "deltasplat: warning: ${outside}" CREATES out.png)
    deltasplat_cli_test(empty_picture.eye_extinction_${between}
        ARGS render cube_8x8x8_uint8.raw -o out.png --projection perspective --extinction 0 --between ${between}
        STDERR "deltasplat: warning: picture: empty, for transfer function and extinction show none of the values 0 to 96"
        CREATES out.png)
endforeach()

deltasplat_cli_test(empty_picture.surface
    ARGS render cube_8x8x8_uint8.raw -o out.png --isovalue 97
    STDERR "deltasplat: warning: --isovalue: got 97, which values from 0 to 96 never pass: nothing is inside
deltasplat: warning: picture: empty, for the surface encloses none of the values 0 to 96"
    CREATES out.png)
foreach(isovalue 0 -5)
    deltasplat_cli_test(input.isovalue.below_${isovalue} CREATES out.png
        ARGS render cube_8x8x8_uint8.raw -o out.png --isovalue=${isovalue}
        STDERR "deltasplat: warning: --isovalue: got ${isovalue}, which values from 0 to 96 never pass: all is inside, and shown is all of the volume, as a solid")
endforeach()

foreach(mode xray mip)
    deltasplat_cli_test(input.light.${mode} CREATES out.exr
        ARGS render cube_8x8x8_uint8.raw -o out.exr --light head --mode ${mode}
        STDERR "deltasplat: warning: --light: has no effect with --mode ${mode}")
    deltasplat_cli_test(input.range.${mode} CREATES out.exr
        ARGS render cube_8x8x8_uint8.raw -o out.exr --range 0,1 --mode ${mode}
        STDERR "deltasplat: warning: --range: has no effect with --mode ${mode}")
endforeach()

# A simulation's cache: its density is taken, wherever it stands and whatever its solver left.
foreach(grid "cache;density" "cache_named;steam")
    list(GET grid 0 file)
    list(GET grid 1 name)
    deltasplat_cli_test(input.${file}.render ARGS render ${file}.vdb -o out.exr CREATES out.exr
        STDERR "deltasplat: warning: ${file}.vdb: reading grid \"${name}\" of 5 scalar grids (--grid chooses another)")
endforeach()
deltasplat_cli_test(input.cache.info ARGS info cache.vdb
    STDOUT_MATCHES "flags.*shadow.*speed.*density.*not read +phi_obstacle [(]level set with NaN or infinite values[)]")
foreach(command "convert" "delta --scalars-only")
    separate_arguments(words UNIX_COMMAND "${command}")
    list(GET words 0 word)
    deltasplat_cli_test(input.cache.${word} ARGS ${words} cache.vdb out.vdb CREATES out.vdb
        STDERR "deltasplat: warning: cache.vdb: left out phi_obstacle (level set with NaN or infinite values)")
endforeach()
deltasplat_cli_test(input.cache.asked EXIT 3 ARGS render cache.vdb -o out.exr --grid phi_obstacle
    STDERR "deltasplat: cache.vdb: grid \"phi_obstacle\": got 7 NaN or infinite active values, the first at (2, 3, 3); expected finite values (--nan VALUE replaces them)")
