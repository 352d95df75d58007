# Media of several grids: fire and colours (scripts/medium.sh looks at the pictures).
set(fire render fire.vdb -o out.exr --size 8x8 --grid density)
set(grids "density (float), Flame (float), temperature (float), celsius (float), cold (float), coarse (float), fine (float), far (float), Cd (vec3s), v (vec3s), r (float), g (float), b (float)")

function(deltasplat_medium name)
    cmake_parse_arguments(PARSE_ARGV 1 ARG "" "WARNS" "ARGS")
    deltasplat_cli_test(medium.${name} CREATES out.exr ARGS ${fire} ${ARG_ARGS}
        STDERR "deltasplat: warning: ${ARG_WARNS}")
endfunction()

deltasplat_medium(flame ARGS --emission-grid auto
    WARNS "--emission-grid: values of Flame, 0.75 to 0.75, seem to be no kelvin; 1 is taken for 2000 K (--temperature-scale)")
deltasplat_cli_test(medium.kelvin CREATES out.exr ARGS ${fire} --emission-grid temperature)
deltasplat_cli_test(medium.scaled CREATES out.exr
    ARGS ${fire} --emission-grid Flame --temperature-scale 1800,200)
deltasplat_medium(cold ARGS --emission-grid cold --temperature-scale 1000
    WARNS "--emission-grid: nothing of cold glows, for the hottest has 100 K, and nothing below 500 K is seen to")
deltasplat_medium(dark_auto ARGS --emission-grid auto --temperature-scale 100
    WARNS "--emission-grid: nothing of Flame glows, for the hottest has 75 K, and nothing below 500 K is seen to
deltasplat: warning: --emission-grid: auto takes Flame, nothing of which glows; temperature is another that may, where it is named")
deltasplat_cli_test(medium.celsius CREATES out.exr
    ARGS render celsius.vdb -o out.exr --size 8x8 --grid density --emission-grid temperature
    STDERR "deltasplat: warning: --emission-grid: values of temperature, -20 to 900, are taken for kelvin, of which there are none below 0; --temperature-scale 1,273.15 takes degrees Celsius")
deltasplat_medium(coarse ARGS --emission-grid coarse
    WARNS "--emission-grid: grid coarse has voxels of 2,2,2, density of 1,1,1, or lies between these: read between them")
deltasplat_medium(fine ARGS --emission-grid fine
    WARNS "--emission-grid: grid fine has voxels of 0.25,0.25,0.25, density of 1,1,1: the mean of those that fall into one of these is shown")
deltasplat_medium(far ARGS --emission-grid far
    WARNS "--emission-grid: grid far lies from 94,-6,-6 to 106,6,6 and nowhere in density, which lies from -6,-6,-6 to 6,6,6")
deltasplat_cli_test(medium.colors CREATES out.exr ARGS ${fire} --color-grid auto)
deltasplat_cli_test(medium.three_floats CREATES out.exr ARGS ${fire} --color-grid r,g,b)
deltasplat_cli_test(medium.part CREATES out.exr
    ARGS render fire.vdb -o out.exr --size 8x8 --grid Cd.z)

deltasplat_cli_test(medium.no_grid EXIT 3 ARGS ${fire} --emission-grid lava
    STDERR "deltasplat: fire.vdb: got no grid \"lava\"; expected one of ${grids}")
deltasplat_cli_test(medium.no_auto EXIT 3
    ARGS render ball.vdb -o out.exr --size 8x8 --emission-grid auto
    STDERR "deltasplat: --emission-grid: got auto and no grid of such a name; expected the name of one of density (float)")
deltasplat_cli_test(medium.negative_colors EXIT 3 ARGS ${fire} --color-grid v
    STDERR "deltasplat: --color-grid: got v.x of -1; expected colours of at least 0")
deltasplat_cli_test(medium.color_type EXIT 3 ARGS ${fire} --color-grid Flame
    STDERR "deltasplat: --color-grid: got Flame of type float; expected a vec3s or vec3d grid, or three of floats R,G,B, of ${grids}")
deltasplat_cli_test(medium.no_color EXIT 3 ARGS ${fire} --color-grid paint
    STDERR "deltasplat: --color-grid: got no grid \"paint\"; expected a vec3s or vec3d grid, or three of floats R,G,B, of ${grids}")
deltasplat_cli_test(medium.two_colors EXIT 2 ARGS ${fire} --color-grid r,g
    STDERR "deltasplat: --color-grid: got r,g; expected one vector grid, or three of floats R,G,B")
deltasplat_cli_test(medium.not_vdb EXIT 2
    ARGS render ${cube} -o out.exr --size 8x8 --emission-grid heat
    STDERR "deltasplat: --emission-grid: got it with ${cube}; expected it with a .vdb input")
deltasplat_cli_test(medium.besides EXIT 2 ARGS ${fire} --emission-grid Flame --shade
    STDERR "deltasplat: --emission-grid: got --shade besides; expected one of the two")
deltasplat_cli_test(medium.color_besides EXIT 2 ARGS ${fire} --color-grid Cd --color-by x
    STDERR "deltasplat: --color-grid: got --color-by x besides; expected --color-by value")
deltasplat_cli_test(medium.between EXIT 2
    ARGS ${fire} --emission-grid temperature --between 1
    STDERR "deltasplat: --between: got 1 with --emission-grid or --color-grid; expected 0: lit fog and media of several grids are drawn by whole voxels")
deltasplat_cli_test(medium.layer_besides EXIT 2 ARGS ${fire} --layer Flame:fire
    STDERR "deltasplat: --layer: got --grid besides; expected one of the two")
foreach(layer Flame Flame: :fire)
    string(MAKE_C_IDENTIFIER ${layer} name)
    deltasplat_cli_test(medium.layer_${name} EXIT 2
        ARGS render fire.vdb -o out.exr --layer ${layer}
        STDERR "deltasplat: --layer: got ${layer}; expected GRID:TF, TF being a file, a preset or fire, as in heat:fire")
endforeach()
deltasplat_cli_test(medium.lit_layers EXIT 2
    ARGS render fire.vdb -o out.exr --layer density:grey --layer Flame:grey --lighting scatter
    STDERR "deltasplat: --layer: got several that swallow light with --lighting scatter; expected one, and fire")
deltasplat_cli_test(medium.many_layers EXIT 2
    ARGS render fire.vdb -o out.exr --layer r:grey --layer g:grey --layer b:grey --layer cold:grey --layer density:grey
    STDERR "deltasplat: --layer: got 5 of them; expected at most 4")
deltasplat_cli_test(medium.layer_not_vdb EXIT 2
    ARGS render ${cube} -o out.exr --size 8x8 --layer nosuch:grey
    STDERR "deltasplat: --layer: got it with ${cube}; expected it with a .vdb input")
deltasplat_medium(outlier ARGS --emission-grid temperature --temperature-scale 1000
    WARNS "--emission-grid: values of temperature, 1500 to 1500, reach 1500000 K; what is hotter than 100000 K is taken for that
deltasplat: warning: out.exr: 60 pixels are brighter than 65504, the most that halves hold, and clipped to it: --float keeps them")
deltasplat_cli_test(medium.clear_density CREATES out.exr
    ARGS render fire.vdb -o out.exr --size 8x8 --layer temperature:fire --density-scale 1
    STDERR "deltasplat: warning: --density-scale: has no effect without a --layer that swallows light")
deltasplat_cli_test(medium.cut_coarse EXIT 2
    ARGS ${fire} --emission-grid coarse --clip 0,0,0,1,0,0 -qq
    STDERR "deltasplat: --emission-grid: got grid coarse, whose voxels are others than those of density, which is cut; expected grids of the same voxels, or nothing cut")
deltasplat_unused(medium_light --light "on a medium of several grids without --lighting scatter"
    CREATES out.exr ARGS ${fire} --emission-grid temperature --light 1,0,0)
foreach(scale x 1,2,3 1,)
    string(MAKE_C_IDENTIFIER scale_${scale} name)
    deltasplat_cli_test(medium.${name} EXIT 2 ARGS ${fire} --temperature-scale ${scale}
        STDERR "deltasplat: --temperature-scale: got ${scale}; expected SCALE or SCALE,OFFSET, as in 1,273.15")
endforeach()
deltasplat_cli_test(medium.strength EXIT 2 ARGS ${fire} --emission-strength=-1
    STDERR "deltasplat: --emission-strength: got -1; expected a finite number from 0 to 1e+06")

foreach(option emission-tf=grey emission-range=1,2 emission-strength=2 temperature-scale=2)
    string(REGEX REPLACE "=.*" "" name ${option})
    deltasplat_unused(medium_${name} --${name} "without --emission-grid, or a --layer shown as fire"
        CREATES out.exr ARGS ${fire} --${option})
endforeach()
deltasplat_unused(medium_range --emission-range "without --emission-tf" CREATES out.exr
    ARGS ${fire} --emission-grid temperature --emission-range 1,2)
deltasplat_unused(medium_kelvin --temperature-scale "with --emission-tf, which is of values"
    CREATES out.exr
    ARGS ${fire} --emission-grid temperature --emission-tf grey --temperature-scale 2)
deltasplat_unused(medium_mode --emission-grid "with --mode xray" CREATES out.exr
    ARGS ${fire} --mode xray --emission-grid temperature)
deltasplat_unused(surface_density_scale --density-scale "on a surface" CREATES out.exr
    ARGS render ${cube} -o out.exr --size 8x8 --isovalue 50 --density-scale 2)

deltasplat_script_test(medium medium.sh
    ARGS ${tool} ${DELTASPLAT_OIIOTOOL} ${scratch}/medium ${DELTASPLAT_FIXTURES}/fire.vdb)
set_tests_properties(cli.medium PROPERTIES FIXTURES_REQUIRED cli_files)

# Channels beside the picture.
deltasplat_refusal(aov_unknown
    "--aov: got depth,height; expected some of depth, front, back, position, normal, emission, ambient, direct, transmittance, mattes, samples and shadow, with commas between"
    --aov depth,height)
deltasplat_cli_test(usage.aov_png EXIT 2 ARGS render ${cube} -o out.png --aov depth
    STDERR "deltasplat: --aov: got out.png; expected an .exr file")
deltasplat_refusal(aov_mode "--aov: got --mode mip; expected --mode composite" --aov depth --mode mip)
deltasplat_refusal(aov_deep "--aov: got --deep besides; expected a flat picture, or --deep alone"
    --aov depth --deep)
deltasplat_refusal(aov_direct
    "--aov direct: got what shines by itself; expected --lighting scatter, light in fog"
    --size 8x8 --aov direct)
deltasplat_cli_test(medium.aov_normal EXIT 2
    ARGS render fire.vdb -o out.exr --size 8x8 --layer r:grey --layer g:grey --aov normal
    STDERR "deltasplat: --aov normal: got a medium of several grids that swallow light; expected one that does")
deltasplat_refusal(aov_mattes
    "--aov: got mattes of one volume; expected several --layer that swallow light" --aov mattes)
deltasplat_cli_test(medium.aov_mattes_of_fire EXIT 2
    ARGS render fire.vdb -o out.exr --layer density:grey --layer temperature:fire --aov mattes
    STDERR "deltasplat: --aov: got mattes of one volume; expected several --layer that swallow light")
foreach(opacity 0 1.5 half)
    deltasplat_refusal(depth_opacity_${opacity}
        "--depth-opacity: got ${opacity}; expected a finite number from 0.001 to 1"
        --aov front --depth-opacity ${opacity})
endforeach()
deltasplat_unused(depth_opacity --depth-opacity "without --aov front" CREATES out.exr
    ARGS render ${cube} -o out.exr --size 8x8 --aov back --depth-opacity 0.3)
deltasplat_cli_test(medium.aov_surface CREATES out.exr
    ARGS render ball.vdb -o out.exr --size 8x8 --isovalue 0.5 --aov depth,front,back,position,normal,samples)
deltasplat_refusal(holdout_mode "--holdout-depth: got --mode mip besides; expected --mode composite"
    --holdout-depth z.exr --mode mip)
deltasplat_refusal(holdout_deep "--holdout-depth: got --deep besides; expected one of the two"
    --holdout-depth z.exr --deep)
deltasplat_cli_test(usage.holdout_missing EXIT 3
    ARGS render ${cube} -o out.exr --size 8x8 --holdout-depth none.exr
    STDERR "deltasplat: none.exr: got no such file; expected a readable file")
