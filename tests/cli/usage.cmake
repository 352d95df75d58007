# What the program says to those who call it: help, versions and everything that ends with 2.
set(cube cube_8x8x8_uint8.raw)

# The library's texts name options by their fields, of which the program makes flags.
deltasplat_script_test(option_names option_names.sh ARGS $<TARGET_FILE:deltasplat_tool>
    ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_BINARY_DIR}/cli/option_names)

# Declares a rendering of the cube that has to be refused: name, message, options.
function(deltasplat_refusal name message)
    deltasplat_cli_test(usage.${name} EXIT 2 STDERR "deltasplat: ${message}"
                        ARGS render cube_8x8x8_uint8.raw -o out.exr ${ARGN})
endfunction()

deltasplat_cli_test(help ARGS --help STDOUT_MATCHES "Subcommands:.*info.*convert.*delta.*restore.*diff.*render.*fold.*bench.*synth")
deltasplat_cli_test(help_short ARGS -h STDOUT_MATCHES "Usage: deltasplat")
deltasplat_cli_test(help_info ARGS info --help
    STDOUT_MATCHES "--level-set.*default keep.*Examples:.*deltasplat info.*deltasplat info")
deltasplat_cli_test(help_render ARGS render --help
    STDOUT_MATCHES "default 512x512.*one sheet pixel each.*0.3 of a voxel.*Examples:.*deltasplat render.*deltasplat render")
deltasplat_cli_test(help_fold ARGS fold --help
    STDOUT_MATCHES "PARTS.*--background.*--region.*Examples:.*deltasplat fold.*deltasplat fold")
deltasplat_cli_test(help_synth ARGS synth -h
    STDOUT_MATCHES "default 64x64x64.*Examples:.*deltasplat synth.*deltasplat synth")
deltasplat_cli_test(version ARGS --version
    STDOUT_MATCHES "deltasplat ${PROJECT_VERSION}.*OpenVDB 1.*OpenImageIO .*TBB .*SIMD level [A-Z]")
deltasplat_cli_test(version_of_subcommand ARGS render --version STDOUT_MATCHES "OpenVDB")

deltasplat_cli_test(usage.no_subcommand EXIT 2 ARGS -q
    STDERR "deltasplat: subcommand: got nothing; expected info, convert, delta, restore, diff, render, fold, bench or synth (see 'deltasplat --help')")
deltasplat_cli_test(usage.unknown_subcommand EXIT 2 ARGS rendr ${cube} -o out.exr
    STDERR "deltasplat: Unknown subcommand 'rendr'. Did you mean 'render'? Expected info, convert, delta, restore, diff, render, fold, bench or synth")
deltasplat_cli_test(usage.unlike_any_subcommand EXIT 2 ARGS compress
    STDERR "deltasplat: Unknown subcommand 'compress'. Expected info, convert, delta, restore, diff, render, fold, bench or synth")
deltasplat_cli_test(usage.unknown_option_before EXIT 2 ARGS --verbos info ${cube}
    STDERR "deltasplat: Unknown option '--verbos'. Did you mean '--verbose'?")
deltasplat_cli_test(usage.output_option EXIT 2 ARGS convert ${cube} -o out.vdb
    STDERR "deltasplat: Unknown option '-o'. OUTPUT is the last argument, without one")
# The names that there are, and the one that is nearest: letters that have changed places count once.
deltasplat_refusal(unknown_option_swapped "Unknown option '--szie'. Did you mean '--size'?" --szie 8x8)
deltasplat_refusal(mode_swapped
    "--mode: got mpi; expected composite, xray, mip, min, average or drr. Did you mean 'mip'?" --mode mpi)
deltasplat_refusal(view_swapped
    "--view: got tpo; expected one of front, back, left, right, top, bottom, iso. Did you mean 'top'?"
    --view tpo)
deltasplat_refusal(filter_slip
    "--filter: got mitchel; expected catmull-rom, mitchell, gauss or box. Did you mean 'mitchell'?"
    --filter mitchel)
deltasplat_refusal(aov_slip
    "--aov: got front,dept; expected some of depth, front, back, position, normal, emission, ambient, direct, transmittance, mattes, samples and shadow, with commas between. Did you mean 'depth'?"
    --aov front,dept)
deltasplat_cli_test(usage.grid_slip EXIT 3 ARGS render ball.vdb -o out.exr --grid densty
    STDERR_MATCHES "deltasplat: ball.vdb: got no grid \"densty\"; expected one of density .*[.] Did you mean 'density'[?]")
deltasplat_refusal(background_word
    "--background: got black; expected R,G,B or R,G,B,A, numbers of at least 0 and A at most 1, scene-linear: 1,1,1 is white, 0.216,0.216,0.216 is #808080"
    --background black)
deltasplat_cli_test(usage.help_of ARGS help render STDOUT_MATCHES "Renders one picture of a volume[.].*--size WxH")
deltasplat_cli_test(usage.help_alone ARGS help STDOUT_MATCHES "'deltasplat help SUBCOMMAND' explains a subcommand")

# Inputs that other subcommands read.
set(readable ".vdb, .raw, .npy, .nrrd, .nhdr, .mhd, .mha, .nii, .hdr, .img (all of these also with .gz), .dcm, .tif, .tiff, .png, .jpg, .jpeg, .bmp, .pgm or .exr")
deltasplat_cli_test(usage.info_of_usda EXIT 3 ARGS info scene.usda
    STDERR "deltasplat: scene.usda: got extension \".usda\"; expected ${readable} (render reads .usda)")

deltasplat_refusal(unknown_option "Unknown option '--sise'. Did you mean '--size'?" --sise 8x8)
deltasplat_refusal(unknown_option_equals "Unknown option '--metod'. Did you mean '--method'?"
    --metod=delta)
deltasplat_refusal(unlike_any_option "Unknown option '--wireframe'." --wireframe)
deltasplat_refusal(two_inputs "Unexpected argument 'ball.vdb'; see 'deltasplat render --help' (many files: a pattern in quotes)"
    ball.vdb)
deltasplat_cli_test(usage.verbose EXIT 2 ARGS render ${cube} -o "a b.exr" --size 12x -v
    STDERR "deltasplat: --size: got 12x; expected WxH, two whole numbers from 1 to 2147483647
  command line: deltasplat render cube_8x8x8_uint8.raw -o 'a b.exr' --size 12x -v")

deltasplat_cli_test(usage.render_no_input EXIT 2 ARGS render -o out.exr
    STDERR "deltasplat: INPUT: got nothing; expected FILE (see 'deltasplat render --help')")
deltasplat_cli_test(usage.render_no_output EXIT 2 ARGS render ${cube}
    STDERR "deltasplat: --output: got nothing; expected FILE (see 'deltasplat render --help')")
deltasplat_cli_test(usage.fold_no_parts EXIT 2 ARGS fold -o out.exr
    STDERR "deltasplat: PARTS: got nothing; expected FILE (see 'deltasplat fold --help')")
deltasplat_cli_test(usage.fold_no_output EXIT 2 ARGS fold a.slabs
    STDERR "deltasplat: --output: got nothing; expected FILE (see 'deltasplat fold --help')")
deltasplat_cli_test(usage.info_no_input EXIT 2 ARGS info --json
    STDERR "deltasplat: INPUT: got nothing; expected FILE (see 'deltasplat info --help')")
deltasplat_cli_test(usage.synth_no_output EXIT 2 ARGS synth cloud
    STDERR "deltasplat: OUTPUT: got nothing; expected FILE (see 'deltasplat synth --help')")
deltasplat_refusal(no_value "--size: got nothing; expected WxH (see 'deltasplat render --help')"
    --size)

# Numbers are taken whole, finite and in range.
set(size_expected "expected WxH, two whole numbers from 1 to 2147483647")
foreach(size 12x 8 8x 8x8x8 0x8 8x-8 8.5x8 3000000000x1 8X8)
    deltasplat_refusal(size_${size} "--size: got ${size}; ${size_expected}" --size ${size})
endforeach()
deltasplat_cli_test(usage.size_absurd EXIT 1
    ARGS render ${cube} -o out.exr --size 2147483647x2147483647
    STDERR_MATCHES "deltasplat: --size 2147483647x2147483647: needs [0-9.]+ [GE]iB of memory; expected at most [0-9.]+ .iB, which is available")
foreach(sigma nan inf 0.1 5 1,0 0.4x 1e)
    deltasplat_refusal(sigma_${sigma}
        "--sigma: got ${sigma}; expected a finite number from 0.2 to 4" --sigma ${sigma})
endforeach()
foreach(tolerance 1 1.5)
    deltasplat_refusal(tolerance_${tolerance}
        "--tolerance: got ${tolerance}; expected a finite number of at least 0 and less than 1"
        --tolerance ${tolerance})
endforeach()
deltasplat_refusal(tolerance_below_0
    "--tolerance: got -0.1; expected a finite number of at least 0" --tolerance -0.1)
deltasplat_refusal(tolerance_value
    "--tolerance-value: got -1; expected a finite number of at least 0" --tolerance-value -1)
foreach(resolution 0 17 1.5 -1 1/3 1/16)
    deltasplat_refusal(resolution_${resolution}
        "--resolution: got ${resolution}; expected a whole number from 1 to 16"
        --resolution ${resolution})
endforeach()
# What voxels that share a pixel were for.
foreach(resolution 1/2 1/8 0.25)
    deltasplat_refusal(resolution_${resolution}
        "--resolution: got ${resolution}; expected 1 or more: voxels that share a pixel are softer, not faster; a smaller --size is"
        --resolution ${resolution})
endforeach()
deltasplat_refusal(azimuth "--azimuth: got 30deg; expected a finite number from -1e+06 to 1e+06" --azimuth 30deg)
deltasplat_refusal(frame_width "--frame-width: got 0; expected a finite number from 1e-30 to 1e+30"
    --frame-width 0)
deltasplat_refusal(unit_distance
    "--unit-distance: got -1; expected a finite number from 1e-30 to 1e+30" --unit-distance -1)
deltasplat_refusal(extinction "--extinction: got -1; expected a finite number from 0 to 1e+30"
    --extinction=-1)
deltasplat_refusal(range "--range: got 5,5; expected LO,HI, two finite numbers with LO < HI"
    --range 5,5)
deltasplat_refusal(background
    "--background: got 1,1; expected R,G,B or R,G,B,A, numbers of at least 0 and A at most 1"
    --background 1,1)
deltasplat_refusal(background_alpha
    "--background: got 1,1,1,2; expected R,G,B or R,G,B,A, numbers of at least 0 and A at most 1"
    --background 1,1,1,2)
deltasplat_refusal(threads "--threads: got -1; expected a whole number from 0 to 1024" --threads -1)
deltasplat_cli_test(usage.simd EXIT 2 ARGS render ${cube} -o out.exr --simd MMX
    STDERR_MATCHES "deltasplat: SIMD level: got MMX; expected one of auto, .*")
deltasplat_refusal(control_characters "Unknown option '--a?b'." "--a\nb")
deltasplat_refusal(nan "--nan: got inf; expected a finite number" --nan inf)

# What no picture could be made with.
foreach(option frame-width unit-distance)
    deltasplat_refusal(${option}_out_of_range
        "--${option}: got 1e308; expected a finite number from 1e-30 to 1e+30" --${option} 1e308)
endforeach()
deltasplat_refusal(azimuth_out_of_range
    "--azimuth: got 1e308; expected a finite number from -1e+06 to 1e+06" --azimuth 1e308)
deltasplat_refusal(origin_out_of_range
    "--origin: got 1e308,0,0; expected X,Y,Z, three numbers from -1e+15 to 1e+15"
    --origin 1e308,0,0)
deltasplat_refusal(target_out_of_range
    "--target: got 0,1e308,0; expected X,Y,Z, three numbers from -1e+30 to 1e+30"
    --target 0,1e308,0)

# Names that begin with a dash.
deltasplat_cli_test(usage.dash_output ARGS render ${cube} -o=-x.png CREATES -x.png)
deltasplat_cli_test(usage.dash_output_long ARGS render ${cube} --output=-x.png CREATES -x.png)
deltasplat_cli_test(usage.dash_input EXIT 3 ARGS info -- -fail.vdb
    STDERR_MATCHES "deltasplat: -fail.vdb: .*")
deltasplat_cli_test(usage.dashes_end_options ARGS render -o out.png -- ${cube} CREATES out.png)
deltasplat_cli_test(usage.dashes_for_outputs EXIT 2 ARGS convert -- ${cube} --float
    STDERR_MATCHES "deltasplat: --float: got extension .*")

# Words.
deltasplat_refusal(method "--method: got fast; expected auto, delta, sparse or traditional"
    --method fast)
deltasplat_refusal(progressive_sheet
    "--contact-sheet: got --progressive besides; expected one of them"
    --progressive --turntable 4 --contact-sheet 2x2)
deltasplat_refusal(filter "--filter: got lanczos; expected catmull-rom, mitchell, gauss or box"
    --filter lanczos)
deltasplat_refusal(mode "--mode: got depth; expected composite, xray, mip, min, average or drr"
    --mode depth)
deltasplat_refusal(drr_and_mode "--drr: got --mode mip besides; expected --mode drr" --drr --mode mip)
deltasplat_refusal(isovalue "--isovalue: got nan; expected a finite number" --isovalue nan)
deltasplat_refusal(surface_color
    "--surface-color: got 1,0; expected R,G,B, three numbers of at least 0"
    --isovalue 1 --surface-color 1,0)
deltasplat_refusal(surface_color_negative
    "--surface-color: got -1,0,0; expected R,G,B, three numbers of at least 0"
    --isovalue 1 --surface-color=-1,0,0)
deltasplat_refusal(surface_color_alpha
    "--surface-color: got 1,0,0,1; expected R,G,B, three numbers of at least 0"
    --isovalue 1 --surface-color 1,0,0,1)
deltasplat_refusal(surface_of_values
    "--surface: got values that are no distances; expected a level set, or --isovalue V" --surface)
deltasplat_refusal(surface_and_color_by
    "--isovalue: got --color-by x besides; expected --color-by value" --isovalue 1 --color-by x)
deltasplat_cli_test(usage.surface_and_fog EXIT 2
    STDERR "deltasplat: --surface: got --level-set fog besides; expected --level-set keep"
    ARGS render level_set.vdb -o out.exr --surface --level-set fog)
deltasplat_refusal(surface_and_gradients
    "--isovalue: got --gradient-opacity besides; expected one of the two"
    --isovalue 1 --gradient-opacity 0:1)
# Light in fog.
deltasplat_refusal(lighting "--lighting: got sun; expected emission or scatter" --lighting sun)
foreach(albedo 2 -0.1 1,1 nan 1,1,x)
    string(MAKE_C_IDENTIFIER albedo_${albedo} name)
    deltasplat_cli_test(usage.${name} EXIT 2 ARGS render ${cube} -o out.exr --albedo=${albedo}
        STDERR_MATCHES "deltasplat: --albedo: got ${albedo}; expected .*0[.][.]1.*|deltasplat: --albedo: got ${albedo}; expected a finite number from 0 to 1")
endforeach()
foreach(lobes 1 0.8,0.3 0.8,0.3,2)
    string(MAKE_C_IDENTIFIER anisotropy_${lobes} name)
    deltasplat_refusal(${name}
        "--anisotropy: got ${lobes}; expected G within -0.99..0.99, or G,G2,SHARE of two lobes, SHARE of the second within 0..1, as in 0.8,-0.3,0.2"
        --anisotropy ${lobes})
endforeach()
foreach(sky 0,0,0 1,2 1,2,3:x 1,2,3:-1 1,2,3:1:1)
    string(MAKE_C_IDENTIFIER sky_${sky} name)
    deltasplat_refusal(${name}
        "--sky: got ${sky}; expected X,Y,Z, the way towards the sun, not all 0, then, if wanted, :STRENGTH, as in 1,2,1:4"
        --sky=${sky})
endforeach()
deltasplat_cli_test(usage.sun_below EXIT 2 ARGS render ${cube} -o out.exr --sky 1,-1,0
    STDERR "deltasplat: --sky: got 1,-1,0, below the horizon; expected a sun above it: of twilight nothing is known")
deltasplat_refusal(scatter_and_shade
    "--lighting scatter: got --shade besides; expected one of the two" --lighting scatter --shade)
deltasplat_refusal(scatter_and_surface
    "--lighting scatter: got --isovalue besides; expected one of the two"
    --lighting scatter --isovalue 3)
deltasplat_refusal(scatter_and_gradients
    "--lighting scatter: got --gradient-opacity besides; expected one of the two"
    --lighting scatter --gradient-opacity 0:1)
deltasplat_refusal(scatter_and_color_by
    "--lighting scatter: got --color-by x besides; expected --color-by value"
    --lighting scatter --color-by x)
deltasplat_refusal(scatter_and_head_light
    "--light: got head or view:X,Y,Z with --lighting scatter; expected X,Y,Z, the way that light travels in the world, or point:X,Y,Z"
    --lighting scatter --light head)
deltasplat_refusal(point_light_on_surfaces
    "--light: got point:X,Y,Z without --lighting scatter; expected head, X,Y,Z or view:X,Y,Z"
    --light point:1,2,3)
deltasplat_refusal(join_three "--join: got 3; expected 1, 2, 4, 8, 16 or 32" --join 3)
deltasplat_refusal(scatter_and_between
    "--between: got 1 with --lighting scatter; expected 0: lit fog and media of several grids are drawn by whole voxels"
    --lighting scatter --between 1)
deltasplat_cli_test(usage.env_missing EXIT 3 ARGS render ${cube} -o out.exr --env none.exr
    STDERR "deltasplat: none.exr: got no such file; expected a readable file")
deltasplat_cli_test(usage.env_shape EXIT 3 ARGS render ${cube} -o out.exr --env stack.1.pgm
    STDERR_MATCHES "deltasplat: stack.1.pgm: got .*; expected .*")

foreach(points 1 1:2:3 2:0,1:1 -1:0 1:1.5 x:1)
    string(MAKE_C_IDENTIFIER ${points} name)
    deltasplat_refusal(gradient_opacity_${name}
        "--gradient-opacity: got ${points}; expected GRADIENT:FACTOR,..., gradients of at least 0 in increasing order, factors within 0..1, as in 0:0,200:1"
        --gradient-opacity=${points})
endforeach()
deltasplat_refusal(colorspace_name
    "--colorspace: got none; expected one of ACEScg, lin_srgb, sRGB, half, raw"
    --ocio config.ocio --colorspace none)
deltasplat_refusal(colorspace_mode "--colorspace: got --mode mip; expected --mode composite"
    --colorspace ACEScg --mode mip)
deltasplat_refusal(colorspace_deep
    "--colorspace: got --deep besides; expected a flat picture, or --deep alone"
    --colorspace ACEScg --deep)
deltasplat_refusal(display_exr
    "--display: got out.exr; expected a .png, .tif or .jpg file (an .exr: --colorspace)"
    --display sRGB)
deltasplat_cli_test(usage.colorspace_png EXIT 2
    ARGS render ${cube} -o out.png --ocio config.ocio --colorspace ACEScg
    STDERR "deltasplat: --colorspace: got out.png; expected an .exr file (others: --display)")
deltasplat_cli_test(usage.display_name EXIT 2
    ARGS render ${cube} -o out.png --ocio config.ocio --display none
    STDERR "deltasplat: --display: got none; expected one of sRGB")
deltasplat_cli_test(usage.look_and_tone EXIT 2
    ARGS render ${cube} -o out.png --look swap.cube --tone filmic
    STDERR "deltasplat: --tone: got filmic with --look; expected one of the two")
deltasplat_cli_test(usage.look_missing EXIT 3 ARGS render ${cube} -o out.png --look none.cube
    STDERR "deltasplat: none.cube: got no such file; expected a readable file")
foreach(region 8x8 8x8+1 0x3+1+1 1,2,0,3 8x8+1+1+1 a 3000000000x1+0+0 0,0,2147483647,1)
    string(MAKE_C_IDENTIFIER ${region} name)
    deltasplat_refusal(region_${name}
        "--region: got ${region}; expected WxH+X+Y or XMIN,YMIN,XMAX,YMAX, pixels of the picture, as oiiotool has it"
        --region ${region})
endforeach()
deltasplat_refusal(region_beyond
    "--region: got pixels 500,0 to 512,9; expected all of them among the picture's, 0,0 to 511,511"
    --region 13x10+500+0)
deltasplat_refusal(region_beyond_overscan
    "--region: got pixels -5,0 to 4,9; expected all of them among the picture's, -4,-3 to 515,514"
    --overscan 4,3 --region 10x10-5+0)
foreach(overscan -1 1,2,3 1001% x)
    string(MAKE_C_IDENTIFIER ${overscan} name)
    deltasplat_refusal(overscan_${name}
        "--overscan: got ${overscan}; expected N pixels, X,Y or P%, each at most 1000000 (1000 %)"
        --overscan=${overscan})
endforeach()
deltasplat_cli_test(usage.overscan_png EXIT 2 ARGS render ${cube} -o out.png --overscan 4
    STDERR "deltasplat: --overscan: got out.png; expected an .exr file")
deltasplat_refusal(overscan_latlong
    "--overscan: got --projection latlong; expected --projection ortho or perspective"
    --overscan 4 --projection latlong)
deltasplat_refusal(compression_name
    "--compression: got lzw; expected none, rle, zip, zips, piz, pxr24, b44, b44a, dwaa or dwab"
    --compression lzw)
deltasplat_refusal(compression_level
    "--compression: got zip:10; expected a level that is a whole number within 1..9"
    --compression zip:10)
deltasplat_refusal(compression_without_level
    "--compression: got piz:3; expected a level with zip, zips, dwaa or dwab alone"
    --compression piz:3)
deltasplat_refusal(compression_two_levels
    "--compression: got zip:3:4; expected a name, or a name, : and a level, as in dwaa:45"
    --compression zip:3:4)
deltasplat_refusal(compression_of_deep
    "--compression: got piz of a deep picture; expected zips"
    --compression piz --deep)
foreach(file out.png out.tif out.jpg)
    deltasplat_cli_test(usage.deep_${file} EXIT 2 ARGS render ${cube} -o ${file} --deep
        STDERR "deltasplat: --deep: got ${file}; expected an .exr file")
endforeach()
foreach(mode xray mip min average drr)
    deltasplat_refusal(deep_${mode} "--deep: got --mode ${mode}; expected --mode composite"
        --deep --mode ${mode})
endforeach()
deltasplat_refusal(deep_background
    "--deep: got --background besides; expected none: what lies behind is put there by depth"
    --deep --background 0,0,0)
deltasplat_refusal(deep_axes
    "--axes: got out.exr, whose pixels are light or values alone; expected a .png (render to both)"
    --deep --axes)
foreach(slices 0 -1 1.5 1048577)
    deltasplat_refusal(deep_slices_${slices}
        "--deep-slices: got ${slices}; expected a whole number from 1 to 1048576"
        --deep --deep-slices ${slices})
endforeach()
deltasplat_refusal(deep_distance
    "--distance: got 2; expected at least 4 for a deep picture, all of whose depths are beyond the camera"
    --deep --distance 2)
deltasplat_refusal(distance_of_panorama
    "--distance: got --projection latlong; expected --projection ortho or perspective"
    --projection latlong --size 64x32 --distance 4)
deltasplat_refusal(distance_of_eye "--distance: got -2; expected a finite number > 0"
    --projection perspective --distance -2)
deltasplat_cli_test(usage.deep_memory EXIT 1
    ARGS render ${cube} -o out.exr --deep --size 2147483647x2147483647
    STDERR_MATCHES "deltasplat: --size 2147483647x2147483647: needs [0-9.]+ EiB of memory; expected at most [0-9.]+ .iB, which is available")
deltasplat_refusal(surface_legend
    "--legend: got a surface, which has one colour; expected a picture of values"
    --isovalue 1 --legend -o out.png)
foreach(option mu-water photons)
    foreach(value 0 -1 nan)
        deltasplat_refusal(${option}_${value}
            "--${option}: got ${value}; expected a finite number from 1e-30 to 1e+30"
            --drr --${option} ${value})
    endforeach()
endforeach()
foreach(value -0.1 1.5 nan)
    deltasplat_refusal(depth_shade_${value}
        "--depth-shade: got ${value}; expected a finite number from 0 to 1"
        --mode mip --depth-shade ${value})
endforeach()
deltasplat_refusal(color_by "--color-by: got hue; expected value, x, y, z or index" --color-by hue)
deltasplat_refusal(shade_and_color_by
    "--shade: got --color-by index besides; expected --color-by value" --shade --color-by index)
foreach(light up 1,2 0,0,0 view head: head:1:2:3 1,2,3:1,1 1,2,3:1,1,1:-1 world:1,2,3 1e300,1e300,0 1,2,3:1e7
        point point: point:1,2 point:1,2,3,-1 point:1,2,3,4,5 point:1,2,3,nan point:1,2,nan
        point:1e31,0,0 point:1,2,3:1e7 point:1,2,3:1,1 point:1,2,3,4:1,1,1:2:3 1,2,3,4)
    string(MAKE_C_IDENTIFIER "light_${light}" test)
    deltasplat_refusal(${test}
        "--light: got ${light}; expected head, X,Y,Z or view:X,Y,Z, numbers from -1e+30 to 1e+30 and not all 0, or point:X,Y,Z or point:X,Y,Z,RADIUS, then, if wanted, :R,G,B, each at least 0, and :STRENGTH, 0 to 1e+06, as in view:1,-1,-1:1,0.9,0.8:1.5"
        --light ${light})
endforeach()
deltasplat_refusal(shininess "--shininess: got -1; expected a finite number from 0 to 1e+06"
    --shininess -1)
deltasplat_refusal(projection "--projection: got fisheye; expected ortho, perspective or latlong"
    --projection fisheye)
deltasplat_refusal(level_set "--level-set: got maybe; expected fog or keep" --level-set maybe)
deltasplat_refusal(endian "--endian: got middle; expected little or big" --endian middle)
deltasplat_refusal(bits "--bits: got 12; expected 8 or 16" --bits 12)
foreach(stops nan inf 1e3 -100.1 1,2 bright)
    deltasplat_refusal(exposure_${stops}
        "--exposure: got ${stops}; expected a finite number from -100 to 100" --exposure=${stops})
endforeach()
deltasplat_refusal(tone_capital
    "--tone: got Filmic; expected standard or filmic. Did you mean 'filmic'?" --tone Filmic)
foreach(tone foo 1)
    deltasplat_refusal(tone_${tone} "--tone: got ${tone}; expected standard or filmic"
        --tone ${tone})
endforeach()
deltasplat_refusal(view
    "--view: got side; expected one of front, back, left, right, top, bottom, iso" --view side)

# Cameras that cannot be.
deltasplat_refusal(direction_parallel_to_up
    "--up: got 0,3,0, parallel to the line of sight 0,1,0; expected a direction that differs from it"
    --direction 0,1,0 --up 0,3,0)
deltasplat_refusal(direction_against_up
    "--up: got 0,0,2, parallel to the line of sight 0,0,-1; expected a direction that differs from it"
    --direction 0,0,-1 --up 0,0,2)
deltasplat_refusal(direction_zero
    "--direction: got 0,0,0; expected three finite numbers, not all of them 0" --direction 0,0,0)
deltasplat_refusal(direction_short "--direction: got 1,2; expected X,Y,Z, three numbers from -1e+30 to 1e+30"
    --direction 1,2)
deltasplat_refusal(direction_nan
    "--direction: got 1,nan,0; expected X,Y,Z, three numbers from -1e+30 to 1e+30" --direction=1,nan,0)
deltasplat_refusal(up_zero "--up: got 0,0,0; expected three finite numbers, not all of them 0"
    --up 0,0,0)
# What is up, and so what may not be the direction, may depend on the file.
deltasplat_cli_test(patient.direction CREATES out.exr
    ARGS render patient.vdb -o out.exr --direction 0,1,0)
deltasplat_cli_test(patient.up CREATES out.exr
    ARGS render patient.vdb -o out.exr --view front --up 0,0,1)
deltasplat_cli_test(patient.direction_parallel_to_up EXIT 2
    ARGS render patient.vdb -o out.exr --direction 0,0,1 --up 0,0,1
    STDERR "deltasplat: --up: got 0,0,1, parallel to the line of sight 0,0,1; expected a direction that differs from it")
deltasplat_cli_test(straight_up CREATES out.exr ARGS render ${cube} -o out.exr --direction 0,1,0)
deltasplat_cli_test(view_of_an_eye CREATES out.exr
    ARGS render ${cube} -o out.exr --projection perspective --eye 4,40,4 --target 4,4,4 --view top
    STDERR "deltasplat: warning: --view: has no effect with --eye")
# An eye at the target, which no one has named, looks around as the view says.
deltasplat_cli_test(view_of_an_eye_at_the_middle CREATES out.exr
    ARGS render ${cube} -o out.exr --projection latlong --size 64x32 --eye 3.5,3.5,3.5 --view top)
deltasplat_cli_test(view_of_an_eye_beside_the_middle CREATES out.exr
    ARGS render ${cube} -o out.exr --projection latlong --size 64x32 --eye 3.5,3.5,4 --view top
    STDERR "deltasplat: warning: --view: has no effect with --eye")
deltasplat_cli_test(negative_vectors CREATES out.exr
    ARGS render ${cube} -o out.exr --direction -1,0.8,-0.6 --up=-.5,1,0 --target -1,2,-.25)
deltasplat_cli_test(frame_width_1e-30 CREATES out.exr
    ARGS render ${cube} -o out.exr --size 8x8 --frame-width 1e-30)
deltasplat_cli_test(frame_width_1e30 CREATES out.exr
    ARGS render ${cube} -o out.exr --size 8x8 --frame-width 1e30
    STDERR_MATCHES "deltasplat: warning: picture: empty, .* or is far smaller than a pixel; the volume lies .*")
deltasplat_cli_test(last_value_wins CREATES out.exr
    ARGS render ${cube} -o out.exr --size 0x0x0 --size 8x8)

# Eyes that cannot be.
deltasplat_refusal(fov_zero "--fov: got 0; expected a number of degrees greater than 0 and less than 180"
    --projection perspective --fov 0)
deltasplat_refusal(fov_half_turn
    "--fov: got 180; expected a number of degrees greater than 0 and less than 180"
    --projection perspective --fov 180)
deltasplat_refusal(fov_nan "--fov: got nan; expected a number of degrees greater than 0 and less than 180"
    --projection perspective --fov nan)
deltasplat_refusal(fov_twice "--fov: got it and --focal; expected the angle of view one way or the other"
    --projection perspective --fov 40 --focal 35)
deltasplat_refusal(eye_of_parallel
    "--eye: got --projection ortho; expected --projection perspective or latlong" --eye 1,2,3)
deltasplat_refusal(eye_is_target
    "--eye: got 1,2,3; expected another place than the target 1,2,3, or a --direction to look in"
    --projection perspective --eye 1,2,3 --target 1,2,3)
deltasplat_refusal(eye_far_and_distance
    "--distance: got it and --eye; expected the eye's place one way or the other"
    --projection perspective --eye 1,2,3 --distance 5)
deltasplat_refusal(two_directions
    "--direction: got it, --eye and --target; expected a line of sight one way or the other: without one of them"
    --projection perspective --eye 1,2,3 --target 1,2,9 --direction 1,0,0)
deltasplat_refusal(near_negative "--near: got -1; expected a finite number of at least 0"
    --projection perspective --near -1)
deltasplat_refusal(frame_of_perspective
    "--frame-width: got --projection perspective; expected --projection ortho, of which it is an option"
    --projection perspective --frame-width 5)
deltasplat_refusal(panorama_size
    "--size: got 512x512; expected twice as wide as high for --projection latlong"
    --projection latlong --size 512x512)
set(c_arm --sid 100 --sdd 150 --size 64x48)
deltasplat_refusal(detector_zero
    "--detector: got 0x30; expected WxH, two numbers from 1e-30 to 1e+30" ${c_arm} --detector 0x30)
deltasplat_refusal(detector_one_length
    "--detector: got 30; expected WxH, two numbers from 1e-30 to 1e+30" ${c_arm} --detector 30)
deltasplat_refusal(detector_not_square
    "--detector: got 30x30 of 64x48 pixels; expected square pixels, as 30x22.5"
    ${c_arm} --detector 30x30)
deltasplat_refusal(detector_missing
    "--detector: got none; expected --sid, --sdd and --detector" ${c_arm})
deltasplat_refusal(sid_missing "--sid: got none; expected --sid, --sdd and --detector" --sdd 150)
deltasplat_refusal(sdd_before_isocenter "--sdd: got 90; expected at least --sid 100"
    --sid 100 --sdd 90 --detector 20x20)
deltasplat_refusal(c_arm_of_parallel "--sid: got --projection ortho; expected --projection perspective"
    ${c_arm} --detector 40x30 --projection ortho)
deltasplat_refusal(c_arm_and_lens "--fov: got it and --sid; expected the camera one way or the other"
    ${c_arm} --detector 40x30 --fov 20)
foreach(mode composite xray mip min average)
    deltasplat_cli_test(c_arm_${mode} CREATES out.exr
        ARGS render ${cube} -o out.exr ${c_arm} --detector 40x30 --mode ${mode}
        STDERR "deltasplat: warning: cube_8x8x8_uint8.raw: names no unit of length; --sid takes its lengths for millimetres")
endforeach()
deltasplat_cli_test(detector_within CREATES out.exr
    ARGS render ${cube} -o out.exr --sid 100 --sdd 101 --detector 40x40
    STDERR "deltasplat: warning: cube_8x8x8_uint8.raw: names no unit of length; --sid takes its lengths for millimetres
deltasplat: warning: --sdd: the volume reaches 2.5 beyond the detector, and counts there as well")
deltasplat_cli_test(perspective CREATES out.exr
    ARGS render ${cube} -o out.exr --projection perspective --focal 35 --aperture 24 --distance 40)
deltasplat_cli_test(distance_of_parallel CREATES out.exr
    ARGS render ${cube} -o out.exr --deep --distance 40)
deltasplat_cli_test(perspective_eye CREATES out.exr
    ARGS render ${cube} -o out.exr --projection perspective --eye 3,4,30 --target 4,4,4 --near 1)
deltasplat_cli_test(latlong CREATES out.exr
    ARGS render ${cube} -o out.exr --projection latlong --eye 4.2,3.9,4)

# Raw volumes that cannot be meant.
set(raw info plain.raw --type uint8)
deltasplat_cli_test(usage.no_dims EXIT 2 ARGS ${raw}
    STDERR "deltasplat: plain.raw: got no dimensions; expected --dims XxYxZ and --type TYPE, or a name such as volume_256x256x128_uint8.raw")
deltasplat_cli_test(usage.no_type EXIT 2 ARGS info plain.raw --dims 8x8x8
    STDERR "deltasplat: plain.raw: got no value type; expected --type TYPE, or a name such as volume_256x256x128_uint8.raw")
deltasplat_cli_test(usage.unknown_type EXIT 2 ARGS info plain.raw --dims 8x8x8 --type uint9
    STDERR "deltasplat: --type: got uint9; expected uint8, int8, uint16, int16, uint32, int32, float32 or float64. Did you mean 'uint8'?")
deltasplat_cli_test(usage.unknown_type_of_vdb EXIT 2 ARGS info ball.vdb --type uint9
    STDERR "deltasplat: --type: got uint9; expected uint8, int8, uint16, int16, uint32, int32, float32 or float64. Did you mean 'uint8'?")
foreach(dims 0x8x8 -8x8x8 3000000000x3000000000x3000000000)
    deltasplat_cli_test(usage.dims_${dims} EXIT 2 ARGS ${raw} --dims ${dims}
        STDERR "deltasplat: --dims: got ${dims}; expected each 1..1073741824")
endforeach()
foreach(dims 8x8 8x8x8x8 8x8xy 8x8x99999999999999999999)
    deltasplat_cli_test(usage.dims_${dims} EXIT 2 ARGS ${raw} --dims ${dims}
        STDERR "deltasplat: --dims: got ${dims}; expected AxBxC, three whole numbers")
endforeach()
deltasplat_cli_test(usage.dims_product EXIT 2 ARGS ${raw} --dims 1000000000x1000000000x1000000000
    STDERR "deltasplat: --dims: got 1000000000x1000000000x1000000000 uint8; expected at most 9223372036854775807 bytes")
foreach(spacing 1,0,1 1e200,1e200,1e200 1,1e-110,1 1e-30,1,1 1,1,-1)
    deltasplat_cli_test(usage.spacing_${spacing} EXIT 2
        ARGS ${raw} --dims 8x8x8 --spacing=${spacing}
        STDERR "deltasplat: --spacing: got ${spacing}; expected X,Y,Z, three numbers from 1e-15 to 1e+15")
endforeach()
foreach(spacing 1e-15 1e15)
    deltasplat_cli_test(spacing_${spacing} CREATES out.exr
        ARGS render ${cube} -o out.exr --size 8x8 --spacing ${spacing},${spacing},${spacing})
endforeach()
foreach(origin 7.5e+14,7.5e+14,0 0,8e+14,-8e+14)
    deltasplat_cli_test(usage.origin_${origin} EXIT 2
        ARGS delta ${cube} out.vdb --origin ${origin}
        STDERR "deltasplat: --origin: got ${origin}; expected a place within 1e+15 of 0,0,0")
endforeach()
deltasplat_cli_test(usage.origin_of_images EXIT 2
    ARGS convert stack.\#.pgm out.vdb --origin 9e+14,9e+14,0
    STDERR "deltasplat: --origin: got 9e+14,9e+14,0; expected a place within 1e+15 of 0,0,0")
deltasplat_cli_test(usage.skip_bytes EXIT 2 ARGS ${raw} --dims 8x8x8 --skip-bytes -1
    STDERR "deltasplat: --skip-bytes: got -1; expected a whole number of at least 0")

# Options that have nothing to do here are said to have no effect.
function(deltasplat_unused name option reason)
    deltasplat_cli_test(unused.${name} STDERR "deltasplat: warning: ${option}: has no effect ${reason}"
                        ${ARGN})
endfunction()
deltasplat_unused(grid --grid "without a .vdb input" ARGS info ${cube} --grid foo
    STDOUT_MATCHES uint8)
deltasplat_unused(level_set --level-set "without a .vdb input" ARGS info ${cube} --level-set fog
    STDOUT_MATCHES uint8)
foreach(option dims=8x8x8 type=uint8 endian=big skip-bytes=8)
    string(REGEX REPLACE "=.*" "" name ${option})
    deltasplat_unused(${name} --${name} "without a .raw or .raw.gz input"
        ARGS info ball.vdb --${option} STDOUT_MATCHES density)
endforeach()
foreach(option spacing=1,1,2 origin=1,1,1)
    string(REGEX REPLACE "=.*" "" name ${option})
    deltasplat_unused(${name} --${name} "without an input of raw values or images"
        ARGS info ball.vdb --${option} STDOUT_MATCHES density)
endforeach()
deltasplat_cli_test(used.both ARGS info ball.vdb ${cube} --grid density --spacing 1,1,2
    STDOUT_MATCHES "voxel size +1 x 1 x 2")
deltasplat_unused(bits --bits "on an .exr or a picture of numbers"
    ARGS render ${cube} -o out.exr --size 8x8 --bits 16 CREATES out.exr)
foreach(option ocio=config.ocio working-space=lin_srgb)
    string(REGEX REPLACE "=.*" "" name ${option})
    deltasplat_unused(${name} --${name} "without --colorspace, --display or --look"
        ARGS render ${cube} -o out.exr --size 8x8 --${option} CREATES out.exr)
endforeach()
deltasplat_unused(multipart --multipart "without --aov"
    ARGS render ${cube} -o out.exr --size 8x8 --multipart CREATES out.exr)
foreach(option compression=piz autocrop)
    string(REGEX REPLACE "=.*" "" name ${option})
    deltasplat_unused(${name} --${name} "but in an .exr"
        ARGS render ${cube} -o out.png --size 8x8 --${option} CREATES out.png)
endforeach()
deltasplat_unused(deep_slices --deep-slices "without --deep"
    ARGS render ${cube} -o out.exr --size 8x8 --deep-slices 3 CREATES out.exr)
deltasplat_unused(dither --dither "but in pictures of 8 bits"
    ARGS render ${cube} -o out.tif --size 8x8 --bits 16 --dither 1 CREATES out.tif)
foreach(option exposure=1 tone=filmic)
    string(REGEX REPLACE "=.*" "" name ${option})
    deltasplat_unused(${name}_exr --${name} "on an .exr, which holds light as it is" CREATES out.exr
        ARGS render ${cube} -o out.exr --size 8x8 --${option})
    foreach(mode xray mip)
        deltasplat_unused(${name}_${mode} --${name} "with --mode ${mode}" CREATES out.png
            ARGS render ${cube} -o out.png --size 8x8 --mode ${mode} --${option})
    endforeach()
    deltasplat_unused(${name}_exr_mip --${name} "with --mode mip" CREATES out.exr
        ARGS render ${cube} -o out.exr --size 8x8 --mode mip --${option})
endforeach()
foreach(option light=1,0,0 ambient=0.1 diffuse=1 specular=0.4 shininess=3)
    string(REGEX REPLACE "=.*" "" name ${option})
    deltasplat_unused(no_shade_${name} --${name} "with --no-shade" CREATES out.exr
        ARGS render ${cube} -o out.exr --size 8x8 --no-shade --${option})
endforeach()
deltasplat_unused(window_composite --window "with --mode composite" CREATES out.png
    ARGS render ${cube} -o out.png --size 8x8 --window 0,1)
deltasplat_unused(window_exr --window "on an .exr or a picture of numbers, which hold the values themselves" CREATES out.exr
    ARGS render ${cube} -o out.exr --size 8x8 --mode mip --window 0,1)
deltasplat_unused(window_tf --window "with --tf, whose colours values get" CREATES out.png
    ARGS render ${cube} -o out.png --size 8x8 --mode mip --tf grey --window 0,1)
deltasplat_unused(view --view "with --direction" CREATES out.exr
    ARGS render ${cube} -o out.exr --size 8x8 --view front --direction 1,0,0)
deltasplat_unused(noise --noise "on a volume other than engine and vessels"
    ARGS synth slab out.vdb --noise 0.1 CREATES out.vdb)
deltasplat_unused(synth_spacing --spacing "without a .vdb output"
    ARGS synth slab out.raw --spacing 1,1,2 CREATES out.raw)

foreach(mode xray mip)
    foreach(option method=delta tolerance=0.1 tolerance-value=1 resolution=2 extinction=2
            unit-distance=3 filter=box tf=tf_good.json)
        string(REGEX REPLACE "=.*" "" name ${option})
        deltasplat_unused(${mode}_${name} --${name} "with --mode ${mode}" CREATES out.exr
            ARGS render ${cube} -o out.exr --size 8x8 --mode ${mode} --${option})
    endforeach()
    deltasplat_unused(${mode}_background --background "on an .exr or numbers with --mode ${mode}"
        CREATES out.exr
        ARGS render ${cube} -o out.exr --size 8x8 --mode ${mode} --background 1,1,1)
    deltasplat_cli_test(used.${mode}_background CREATES out.png
        ARGS render ${cube} -o out.png --size 8x8 --mode ${mode} --background 1,1,1)
endforeach()
foreach(mode min average)
    deltasplat_unused(${mode}_sigma --sigma "with --mode ${mode}" CREATES out.exr
        ARGS render ${cube} -o out.exr --size 8x8 --mode ${mode} --sigma 1)
    deltasplat_cli_test(used.${mode}_tf CREATES out.png
        ARGS render ${cube} -o out.png --size 8x8 --mode ${mode} --tf tf_good.json)
endforeach()
deltasplat_unused(depth_shade --depth-shade "without --mode mip" CREATES out.exr
    ARGS render ${cube} -o out.exr --size 8x8 --mode min --depth-shade 0.5)
deltasplat_unused(mu_water --mu-water "without --mode drr" CREATES out.exr
    ARGS render ${cube} -o out.exr --size 8x8 --mode xray --mu-water 0.02)
# Of a file that names no patient's space, --photons in a .png.
deltasplat_cli_test(unused.photons CREATES out.png
    ARGS render ${cube} -o out.png --size 8x8 --drr --photons 1000
    STDERR_MATCHES "deltasplat: warning: --photons: has no effect without --mode drr and an .exr.*--mode drr: is for Hounsfield units [(]air -1000, water 0[)], which values from 0 to 96 of a file that names no patient's space may not be")
foreach(option extinction=2 unit-distance=3 range=1,60)
    string(REGEX REPLACE "=.*" "" name ${option})
    deltasplat_unused(surface_${name} --${name} "on a surface" CREATES out.exr
        ARGS render ${cube} -o out.exr --size 8x8 --isovalue 50 --${option})
endforeach()
foreach(option diffuse=0.3 specular=1 shininess=3)
    string(REGEX REPLACE "=.*" "" name ${option})
    deltasplat_unused(fog_${name} --${name} "on fog, which has no surfaces" CREATES out.exr
        ARGS render ${cube} -o out.exr --size 8x8 --lighting scatter --light 1,0,0 --${option})
endforeach()
foreach(option env-strength=2 env-turn=30)
    string(REGEX REPLACE "=.*" "" name ${option})
    deltasplat_unused(fog_${name} --${name} "without --env" CREATES out.exr
        ARGS render ${cube} -o out.exr --size 8x8 --sky 1,1,1 --${option})
endforeach()
deltasplat_unused(fog_turbidity --turbidity "without --sky" CREATES out.exr
    ARGS render ${cube} -o out.exr --size 8x8 --light 1,0,0 --turbidity 3)
deltasplat_unused(fog_env_lights --env-lights "without --sky or --env" CREATES out.exr
    ARGS render ${cube} -o out.exr --size 8x8 --light 1,0,0 --env-lights 3)
deltasplat_unused(fog_emission --albedo "with --lighting emission" CREATES out.exr
    ARGS render ${cube} -o out.exr --size 8x8 --lighting emission --albedo 0.5)
deltasplat_unused(fog_mode --sky "with --mode xray" CREATES out.exr
    ARGS render ${cube} -o out.exr --size 8x8 --mode xray --sky 1,1,1)
deltasplat_cli_test(used.point_light CREATES out.exr
    ARGS render ${cube} -o out.exr --size 8x8 --lighting scatter
         --light point:1,2,3,0.5:1,0.8,0.5:40 --light point:-9,2,3)
deltasplat_cli_test(used.fog_default CREATES out.exr
    ARGS render ${cube} -o out.exr --size 8x8 --lighting scatter --turbidity 4 --env-lights 8)
deltasplat_cli_test(used.surface_range CREATES out.exr
    ARGS render ${cube} -o out.exr --size 8x8 --isovalue 50 --range 1,60 --tf viridis)
deltasplat_unused(mip_sigma --sigma "with --mode mip" CREATES out.exr
    ARGS render ${cube} -o out.exr --size 8x8 --mode mip --sigma 1)
deltasplat_unused(xray_tf_png --tf "with --mode xray" CREATES out.png
    ARGS render ${cube} -o out.png --size 8x8 --mode xray --tf tf_good.json)
deltasplat_unused(xray_sigma --sigma "with --mode xray" CREATES out.exr
    ARGS render ${cube} -o out.exr --size 8x8 --mode xray --sigma 1)
deltasplat_cli_test(used.mip_tf CREATES out.png
    ARGS render ${cube} -o out.png --size 8x8 --mode mip --tf tf_good.json)

# Outputs that cannot be meant.
deltasplat_cli_test(usage.png_side EXIT 2 ARGS render ${cube} -o out.png --size 1000001x1
    STDERR "deltasplat: --size: got 1000001x1; expected sides of at most 1000000 pixels in a .png")
deltasplat_cli_test(usage.jpg_side EXIT 2 ARGS render ${cube} -o out.jpg --size 65501x1
    STDERR "deltasplat: --size: got 65501x1; expected sides of at most 65500 pixels in a .jpg")
deltasplat_cli_test(usage.jpg_bits EXIT 2 ARGS render ${cube} -o out.jpg --bits 16
    STDERR "deltasplat: --bits: got 16; expected 8 in a .jpg")
deltasplat_cli_test(usage.tif_float EXIT 2 ARGS render ${cube} -o out.tif --float
    STDERR "deltasplat: --float: got out.tif; expected an .exr file")
deltasplat_cli_test(usage.picture_format EXIT 2 ARGS render ${cube} -o out.gif
    STDERR "deltasplat: out.gif: got extension \".gif\"; expected .exr, .png, .tif or .jpg (numbers: .npy, .nrrd or .mha)")
deltasplat_cli_test(usage.picture_no_format EXIT 2 ARGS render ${cube} -o out
    STDERR "deltasplat: out: got extension \"\"; expected .exr, .png, .tif or .jpg (numbers: .npy, .nrrd or .mha)")
# What is drawn over a picture, and where it would say something wrong.
foreach(option legend scale-bar axes annotate=text)
    string(REGEX REPLACE "=.*" "" name ${option})
    deltasplat_cli_test(usage.${name}_exr EXIT 2 ARGS render ${cube} -o out.exr --${option}
        STDERR "deltasplat: --${name}: got out.exr, whose pixels are light or values alone; expected a .png (render to both)")
endforeach()
deltasplat_cli_test(usage.annotate_nothing EXIT 2 ARGS render ${cube} -o out.png --annotate
    STDERR "deltasplat: --annotate: got nothing; expected TEXT (see 'deltasplat render --help')")
deltasplat_cli_test(usage.annotate_empty EXIT 2 ARGS render ${cube} -o out.png "--annotate= "
    STDERR "deltasplat: --annotate: got spaces; expected a line of text")
deltasplat_cli_test(usage.scale_bar_latlong EXIT 2
    ARGS render ${cube} -o out.png --scale-bar --projection latlong
    STDERR "deltasplat: --scale-bar: got --projection latlong; expected ortho or perspective, where it would hold")
deltasplat_cli_test(usage.legend_xray EXIT 2 ARGS render ${cube} -o out.png --legend --mode xray
    STDERR "deltasplat: --legend: got --mode xray, which shows sums and no values; expected composite, mip, min or average")
deltasplat_cli_test(usage.legend_color_by EXIT 2
    ARGS render ${cube} -o out.png --legend --color-by index
    STDERR "deltasplat: --legend: got --color-by index; expected value")
deltasplat_cli_test(annotations_without_room CREATES out.png
    ARGS render ${cube} -o out.png --legend --axes --size 60x40
    STDERR "deltasplat: warning: --legend: has no room in a picture of 60x40 pixels, and is left out
deltasplat: warning: --axes: has no room in a picture of 60x40 pixels, and is left out")

deltasplat_cli_test(usage.float_png EXIT 2 ARGS render ${cube} -o out.png --float
    STDERR "deltasplat: --float: got out.png; expected an .exr file")
deltasplat_refusal(stats_is_picture
    "--stats: got ./out.exr; expected another file than the input, the transfer function and the picture"
    --stats ./out.exr)
deltasplat_refusal(stats_is_input
    "--stats: got ${cube}; expected another file than the input, the transfer function and the picture" --stats ${cube})

deltasplat_cli_test(synth_names ARGS synth STDOUT_MATCHES "marschner-lobb.*engine.*cloud.*fire.*explosion")
deltasplat_cli_test(usage.synth_name EXIT 2 ARGS synth ghost out.vdb
    STDERR "deltasplat: NAME: got \"ghost\"; expected one of marschner-lobb, hydrogen, shepp-logan, engine, cloud, slab, vessels, body, fire, explosion")
deltasplat_cli_test(usage.synth_format EXIT 2 ARGS synth cloud out.txt
    STDERR "deltasplat: out.txt: got extension \".txt\"; expected .raw or .vdb")
# A .raw holds one grid.
deltasplat_cli_test(synth_fire_raw ARGS synth fire out.raw --dims 8x8x8 CREATES out.raw
    STDERR "deltasplat: warning: out.raw: holds density alone; left out temperature, flame, which a .vdb holds")
deltasplat_cli_test(synth_explosion_raw ARGS synth explosion out.raw --dims 8x8x8 -q CREATES out.raw
    STDERR "deltasplat: warning: out.raw: holds density alone; left out temperature, Cd, which a .vdb holds")
deltasplat_cli_test(synth_fire_vdb ARGS synth fire out.vdb --dims 8x8x8 CREATES out.vdb)
deltasplat_cli_test(usage.synth_dims EXIT 2 ARGS synth cloud out.raw --dims 0x1x1
    STDERR "deltasplat: --dims: got 0x1x1; expected AxBxC, three whole numbers from 1 to 2147483647")
deltasplat_cli_test(usage.synth_absurd EXIT 1
    ARGS synth cloud out.raw --dims 2147483647x2147483647x2147483647
    STDERR_MATCHES "deltasplat: --dims: needs [0-9.]+ .iB of memory; expected at most [0-9.]+ .iB, which is available")
deltasplat_cli_test(usage.synth_absurd_vdb EXIT 1
    ARGS synth cloud out.vdb --dims 1x2147483647x2147483647
    STDERR_MATCHES "deltasplat: --dims: needs [0-9.]+ .iB of memory; expected at most [0-9.]+ .iB, which is available")
deltasplat_cli_test(usage.synth_spacing EXIT 2 ARGS synth cloud out.vdb --spacing 1,1,1e16
    STDERR "deltasplat: --spacing: got 1,1,1e16; expected X,Y,Z, three numbers from 1e-15 to 1e+15")
deltasplat_cli_test(usage.synth_type EXIT 2 ARGS synth cloud out.raw --type int8
    STDERR "deltasplat: --type: got int8; expected uint8, uint16 or float32. Did you mean 'uint8'?")
deltasplat_cli_test(usage.synth_noise EXIT 2 ARGS synth engine out.raw --noise 2
    STDERR "deltasplat: --noise: got 2; expected a finite number from 0 to 1")
deltasplat_cli_test(usage.synth_seed EXIT 2 ARGS synth cloud out.raw --seed -1
    STDERR "deltasplat: --seed: got -1; expected a whole number of at least 0")
