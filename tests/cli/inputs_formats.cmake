# Medical formats and images: what the program says and takes. Which file holds what is for the
# tests of the readers.
deltasplat_cli_test(formats.stack ARGS info stack.\#.pgm --spacing 1,1,2
    STDOUT_MATCHES "grid +stack.*type +uint8.*dims +3 x 2 x 2.*voxel size +1 x 1 x 2")
deltasplat_cli_test(formats.one_picture ARGS info stack.1.pgm STDOUT_MATCHES "dims +3 x 2 x 1")
deltasplat_bad_input(stack_missing
    "none.###.png: got no file of that name; expected files such as none.001.png" none.\#\#\#.png)
deltasplat_bad_input(stack_odd
    "odd.2.pgm: got 2x2 uint8, channels: 1; expected 3x2 uint8, channels: 1, as in the first slice"
    odd.\#.pgm)
# libpng would print a line of its own.
deltasplat_bad_input(png_cut
    "cut.png: got what OpenImageIO refuses (Read error: hit end of file); expected a whole image"
    cut.png)
deltasplat_cli_test(formats.unused_dims ARGS info stack.1.pgm --dims 3x2x1
    STDERR "deltasplat: warning: --dims: has no effect without a .raw or .raw.gz input"
    STDOUT_MATCHES "dims +3 x 2 x 1")

# --confine, for every command that reads a volume.
set(outside "outside.mhd: got the file /dev/null outside of its folder; expected files inside of it (--confine)")
foreach(command "info outside.mhd" "render outside.mhd -o out.exr" "convert outside.mhd out.vdb"
        "delta outside.mhd out.vdb" "restore outside.mhd out.vdb" "bench outside.mhd")
    separate_arguments(words UNIX_COMMAND "${command}")
    list(GET words 0 word)
    deltasplat_cli_test(formats.confine.${word} EXIT 3 ARGS ${words} --confine
        STDERR "deltasplat: ${outside}")
endforeach()
deltasplat_cli_test(formats.confine.diff EXIT 4 ARGS diff stack.1.pgm outside.mhd --confine
    STDERR "deltasplat: ${outside}")
deltasplat_cli_test(formats.confine.list EXIT 3 ARGS info --list outside.mhd --confine
    STDERR "deltasplat: ${outside}")
deltasplat_cli_test(formats.confine.inside ARGS info stack.\#.pgm --confine
    STDOUT_MATCHES "dims +3 x 2 x 2")
deltasplat_cli_test(formats.to_npy ARGS convert stack.\#.pgm out.npy CREATES out.npy)

deltasplat_cli_test(formats.nrrd ARGS info text.nrrd
    STDOUT_MATCHES "grid +text.*type +int16.*dims +2 x 3 x 4.*voxel size +1 x 2 x 3")
deltasplat_cli_test(formats.unused_spacing ARGS info text.nrrd --spacing 1,1,1
    STDERR "deltasplat: warning: --spacing: has no effect without an input of raw values or images"
    STDOUT_MATCHES "voxel size +1 x 2 x 3")
deltasplat_bad_input(nrrd_sizes
    "negative.nrrd: got sizes 2 -3 4; expected whole numbers from 1 to 1073741824"
    negative.nrrd)
deltasplat_bad_input(meta_data
    "no_data.mhd: got no data file \"nowhere.raw\"; expected a readable file" no_data.mhd)
