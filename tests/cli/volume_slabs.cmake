# Parts of one picture, cut in depth: render --slab-range, and fold.
deltasplat_script_test(slabs slabs.sh ARGS ${tool} ${DELTASPLAT_OIIOTOOL} ${scratch}/slabs)
deltasplat_script_test(full_disk.slabs full_disk.sh
    ARGS ${tool} ${scratch}/full_disk_slabs full.slabs
         render input_32x32x32_uint8.raw -o full.slabs --size 400x400 --slab-range 1/1)

foreach(share 0/2 3/2 2-1/2 -1/2 1.5/2 /2)
    string(MAKE_C_IDENTIFIER "slab_range_${share}" test)
    deltasplat_refusal(${test}
        "--slab-range: got ${share}; expected one of parts 1/2 to 2/2, or several, 1-2/2"
        --slab-range=${share})
endforeach()
foreach(share 1 1/10001 a/b 1/2/3 1/)
    string(MAKE_C_IDENTIFIER "slab_range_${share}" test)
    deltasplat_refusal(${test}
        "--slab-range: got ${share}; expected a part of so many, 1/4 to 4/4, or several, 2-3/4, of at most 10000"
        --slab-range=${share})
endforeach()
deltasplat_refusal(slab_range_of_a_picture
    "--slab-range: got --output out.exr; expected a .slabs file" --slab-range 1/2)
deltasplat_refusal(slab_range_of_many_joined
    "--slab-range: got --join 4; expected --join 1 or 2" --slab-range 1/2 -o out.slabs --join 4)
deltasplat_refusal(slab_range_of_rays
    "--slab-range: got --mode xray; expected --mode composite"
    --slab-range 1/2 -o out.slabs --mode xray)
foreach(option deep legend slate=0 stats=s.json aov=depth frames=1-2 turntable=3 ground=0,0,0
        holdout-depth=d.exr window=0,1)
    string(REGEX REPLACE "=.*" "" name ${option})
    if(option STREQUAL "slate=0")
        continue()
    endif()
    set(given --${option})
    deltasplat_cli_test(usage.slab_range_with_${name} EXIT 2
        STDERR_MATCHES "deltasplat: (--slab-range: got --${name} besides; expected one of the two|--(frames|turntable|output): got .*)"
        ARGS render cube_8x8x8_uint8.raw -o out.slabs --slab-range 1/2 ${given})
endforeach()
foreach(option float bits=16 tone=filmic exposure=1 background=0,0,0 compression=piz region=1x1+0+0
        autocrop colorspace=ACEScg display=sRGB)
    string(REGEX REPLACE "=.*" "" name ${option})
    deltasplat_cli_test(usage.slab_range_with_${name} EXIT 2
        STDERR "deltasplat: --slab-range: got --${name} besides; expected --${name} of 'deltasplat fold'"
        ARGS render cube_8x8x8_uint8.raw -o out.slabs --slab-range 1/2 --${option})
endforeach()
deltasplat_cli_test(slabs.nothing_there EXIT 3
    STDERR "deltasplat: none.slabs: got no such file; expected a readable file"
    ARGS fold none.slabs -o out.exr)
deltasplat_cli_test(slabs.other_file EXIT 3
    STDERR "deltasplat: cut.png: got another kind of file; expected a whole part of a picture's slabs"
    ARGS fold cut.png -o out.exr)
deltasplat_cli_test(slabs.no_picture EXIT 2
    STDERR "deltasplat: out.gif: got extension \".gif\"; expected .exr, .png, .tif or .jpg (numbers: .npy, .nrrd or .mha)"
    ARGS fold cut.png -o out.gif)
deltasplat_cli_test(slabs.overwrites EXIT 2
    STDERR "deltasplat: --output: got cut.png; expected another file than the parts"
    ARGS fold cut.png -o cut.png)

# Parts by a pattern; what fits no file.
deltasplat_cli_test(fold.no_parts EXIT 3 ARGS fold "s.*.slabs" -o out.exr
    STDERR "deltasplat: s.*.slabs: got no file that fits; expected at least one")
