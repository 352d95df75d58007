# Cameras that other programs have made: files, matrices, and what they cannot be.
deltasplat_script_test(cameras cameras.sh
    ARGS ${tool} ${DELTASPLAT_OIIOTOOL} ${scratch}/cameras ${DELTASPLAT_CASE_FILES})

set(expects_rigid "expected a rotation, perhaps evenly scaled, and a translation in the last row, row by row")
deltasplat_refusal(camera_matrix_short
    "--camera-matrix: got 1,0,0; expected 16 finite numbers, row by row, with commas between"
    --camera-matrix 1,0,0)
deltasplat_refusal(camera_matrix_nan
    "--camera-matrix: got 1,0,0,0,0,1,0,0,0,0,1,0,0,0,nan,1; expected 16 finite numbers, row by row, with commas between"
    --camera-matrix 1,0,0,0,0,1,0,0,0,0,1,0,0,0,nan,1)
deltasplat_refusal(camera_matrix_transposed
    "--camera-matrix: got the translation in the last column; ${expects_rigid}"
    --camera-matrix 1,0,0,4,0,1,0,5,0,0,1,6,0,0,0,1)
deltasplat_refusal(camera_matrix_mirrored "--camera-matrix: got a mirrored one; ${expects_rigid}"
    --camera-matrix=-1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1)
deltasplat_refusal(camera_matrix_singular "--camera-matrix: got a singular matrix; ${expects_rigid}"
    --camera-matrix 1,0,0,0,1,0,0,0,0,0,1,0,0,0,0,1)
deltasplat_refusal(camera_matrix_and_view
    "--view: got it and --camera-matrix; expected the camera one way or the other"
    --view iso --camera-matrix 1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1)
deltasplat_refusal(camera_matrix_and_turntable
    "--turntable: got it and --camera-matrix; expected a camera that options turn"
    --turntable 3 --camera-matrix 1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1)
foreach(option azimuth=3 roll=3 eye=1,2,3 target=1,2,3 fov=3 focal=3 frame-width=3 projection=ortho
        pixel-aspect=2 frame-offset=1,0)
    string(REGEX REPLACE "=.*" "" name ${option})
    deltasplat_refusal(camera_and_${name}
        "--${name}: got it and --camera; expected the camera one way or the other"
        --camera camera_still.json --${option})
endforeach()
deltasplat_refusal(camera_and_turntable
    "--turntable: got it and --camera; expected a camera that options turn"
    --turntable 3 --camera camera_still.json)
foreach(offset 1 1,2,3 1,x 101,0 nan,0)
    string(MAKE_C_IDENTIFIER frame_offset_${offset} name)
    deltasplat_refusal(${name}
        "--frame-offset: got ${offset}; expected X,Y, two numbers from -100 to 100"
        --frame-offset ${offset})
endforeach()
foreach(aspect 0 101 -1 nan x)
    deltasplat_refusal(pixel_aspect_${aspect}
        "--pixel-aspect: got ${aspect}; expected a finite number from 0.01 to 100"
        --pixel-aspect=${aspect})
endforeach()
deltasplat_refusal(pixel_aspect_of_panorama
    "--pixel-aspect: got --projection latlong; expected --projection ortho or perspective"
    --pixel-aspect 2 --projection latlong)
deltasplat_refusal(frame_offset_of_panorama
    "--frame-offset: got --projection latlong; expected --projection ortho or perspective"
    --frame-offset 0,1 --projection latlong)

# Files.
function(deltasplat_camera_refusal file said)
    string(MAKE_C_IDENTIFIER camera_${file} name)
    deltasplat_cli_test(cameras.${name} EXIT 3 STDERR "deltasplat: ${said}"
        ARGS render ${cube} -o out.exr --camera ${file})
endfunction()
deltasplat_camera_refusal(none.json
    "none.json: got no such file; expected a camera (JSON)")
deltasplat_camera_refusal(none.usda
    "none.usda: got no such file; expected USD's text format (.usda)")
deltasplat_camera_refusal(none.exr "none.exr: got no such file; expected a readable file")
deltasplat_camera_refusal(camera.txt
    "camera.txt: got an unknown ending; expected .json, .usda or .exr")
deltasplat_camera_refusal(shot.usdc
    "shot.usdc: got USD that is no text; expected .usda, as usdcat -o x.usda writes it")
deltasplat_camera_refusal(camera_two_fields.json
    "camera_two_fields.json:4: got \"focall\"; expected a field of a camera")
deltasplat_camera_refusal(tf_good.json
    "tf_good.json:1: got an array; expected an object")
deltasplat_camera_refusal(camera.usda
    "camera.usda: got 2 prims of type Camera; expected the path of one behind a colon: /World/still, /World/moving")
deltasplat_camera_refusal(camera.usda:/World/none
    "camera.usda: got no prim of type Camera at /World/none; expected one of /World/still, /World/moving")
deltasplat_camera_refusal(camera_still.json:/a
    "camera_still.json:/a: got no .usda; expected a name behind a .usda's only")
deltasplat_cli_test(cameras.far CREATES out.exr
    STDERR_MATCHES "deltasplat: warning: --camera: the volume reaches [0-9.]+ from the camera, and is seen beyond its far plane at 5 as well"
    ARGS render ${cube} -o out.exr --camera camera_still.json)
deltasplat_cli_test(cameras.moves CREATES out.exr
    STDERR "deltasplat: warning: --camera: it moves, and is shown where it is at frame 1; --frames shows others"
    ARGS render ${cube} -o out.exr --camera camera_moving.json)
deltasplat_cli_test(cameras.holds CREATES out.3.exr out.4.exr
    STDERR "deltasplat: warning: --camera: its keys are frames 1 to 3, and 1 of 2 frames, which are not between them, are shown by the nearest"
    ARGS render ${cube} -o out.\#.exr --camera camera_moving.json --frames 3-4)
deltasplat_cli_test(cameras.still_has_no_frames EXIT 2
    STDERR "deltasplat: INPUT: got ${cube} with --frames; expected a name with ####, %04d, @ or $F4 for the number"
    ARGS render ${cube} -o out.\#.exr --camera camera_still.json --frames 3-4)
deltasplat_cli_test(cameras.bench STDOUT_MATCHES "36 x 24 pixels"
    ARGS bench ${cube} --camera camera_still.json --repeats 1)

# Volumes in scenes.
deltasplat_script_test(scenes scenes.sh
    ARGS ${tool} ${DELTASPLAT_OIIOTOOL} ${scratch}/scenes ${DELTASPLAT_CASE_FILES})
