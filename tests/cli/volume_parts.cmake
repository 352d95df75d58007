# Parts of volumes: boxes, planes, masks and labels.
deltasplat_script_test(parts parts.sh ARGS ${tool} ${DELTASPLAT_OIIOTOOL} ${scratch}/parts)

foreach(crop 1:2,3:4 1:2,3:4,5:6,7:8 2:1,:,: 1,2,3 a:b,:,: 0.5:2,:,: 3000000000:,:,: world:1:2,3:4 box:1:2,:,: 1:2:3,:,:)
    string(MAKE_C_IDENTIFIER "crop_${crop}" test)
    deltasplat_refusal(${test}
        "--crop: got ${crop}; expected I0:I1,J0:J1,K0:K1, first and last voxel along each axis, or world:X0:X1,Y0:Y1,Z0:Z1, as in 10:90,:,20:"
        --crop ${crop})
endforeach()
foreach(slices 5 5:4 w:1:2 x:1 z:a:b 1:2,3)
    string(MAKE_C_IDENTIFIER "slices_${slices}" test)
    deltasplat_refusal(${test}
        "--slices: got ${slices}; expected A:B, first and last slice along z, or x:A:B, y:A:B or z:A:B"
        --slices ${slices})
endforeach()
foreach(plane 0,0,0,0,0,0 1,2,3,1,0 1,2,3,1,0,nan 1,2,3,1,0,0,0 1e31,0,0,1,0,0)
    string(MAKE_C_IDENTIFIER "clip_${plane}" test)
    deltasplat_refusal(${test}
        "--clip: got ${plane}; expected X,Y,Z,NX,NY,NZ, a point and a direction other than 0,0,0, numbers from -1e+30 to 1e+30"
        --clip ${plane})
endforeach()
deltasplat_refusal(crop_outside
    "--crop: got 8:9,:,:; expected a box that overlaps the volume's, 0:7,0:7,0:7" --crop 8:9,:,:)
deltasplat_refusal(crop_outside_world
    "--crop: got the world box 7.5:9,:,:; expected a box with active voxels of those in 0:7,0:7,0:7"
    --crop world:7.5:9,:,:)
deltasplat_refusal(slices_outside
    "--slices: got z:8:; expected slices of those that there are, z:0:7" --slices 8:)
deltasplat_refusal(clip_everything
    "--clip: got planes that leave nothing; expected some voxel beyond all of them, of those in the world box 0:7,0:7,0:7"
    --clip 0,0,7.1,0,0,1)
deltasplat_refusal(hide_labels_of_values
    "--hide-labels: got a transfer function of values; expected a table of labels" --hide-labels 1)
deltasplat_refusal(label_opacity_of_values
    "--label-opacity: got a transfer function of values; expected a table of labels"
    --tf viridis --label-opacity 1=0.5)
foreach(option hide-labels show-labels)
    deltasplat_refusal(${option}_no_number
        "--${option}: got 1,; expected L,L,..., whole numbers from -1000000000 to 1000000000"
        --${option} 1,)
endforeach()
foreach(opacity 1 1=2 x=0.5 1=0.5, 1=0.1,2=1,1=0.3)
    string(MAKE_C_IDENTIFIER "label_opacity_${opacity}" test)
    deltasplat_refusal(${test}
        "--label-opacity: got ${opacity}; expected L=O,L=O,..., each label once, and opacities from 0 to 1"
        --label-opacity ${opacity})
endforeach()
deltasplat_refusal(mask_grid_of_raw
    "--mask: got changed_8x8x8_uint8.raw:density; expected a .vdb before the colon, or no colon"
    --mask changed_8x8x8_uint8.raw:density)
deltasplat_refusal(mask_no_grid
    "--mask: got two.vdb:; expected a name behind the colon" --mask two.vdb:)
deltasplat_refusal(mask_overwritten
    "--stats: got ball.vdb; expected another file than the mask" --mask ball.vdb --stats ball.vdb)

deltasplat_cli_test(parts.mask_dims EXIT 3
    ARGS render cube_8x8x8_uint8.raw -o out.exr --mask half_8x8x4_uint8.raw
    STDERR "deltasplat: --mask: got half_8x8x4_uint8.raw of 8x8x4 voxels; expected 8x8x8, as the volume has, for the files do not say where both lie")
deltasplat_cli_test(parts.mask_missing EXIT 3
    ARGS render cube_8x8x8_uint8.raw -o out.exr --mask missing.vdb
    STDERR_MATCHES "deltasplat: missing.vdb: .*")
deltasplat_cli_test(parts.mask_grid_missing EXIT 3
    ARGS render cube_8x8x8_uint8.raw -o out.exr --mask two.vdb:smoke
    STDERR_MATCHES "deltasplat: two.vdb: .*smoke.*")
deltasplat_cli_test(parts.mask_elsewhere CREATES out.exr
    ARGS render ball.vdb -o out.exr --mask ball_moved.vdb
    STDERR "deltasplat: warning: --mask: its voxels lie elsewhere than the volume's; each of these takes the nearest of those")
deltasplat_cli_test(parts.labels_absent CREATES out.exr
    ARGS render cube_8x8x8_uint8.raw -o out.exr --tf labels.ctbl --hide-labels=-4,1,7 --label-opacity 5=1
    STDERR "deltasplat: warning: --hide-labels: no label 7 in the table
deltasplat: warning: --hide-labels: no label -4 in the table or the volume
deltasplat: warning: --label-opacity: no label 5 in the table
deltasplat: warning: --tf: labels 3, 4, 5, 6, 8 and 88 more of the volume are not in the table, and not shown")
# What is hidden on purpose is not missed.
deltasplat_cli_test(parts.labels_shown CREATES out.exr
    ARGS render cube_8x8x8_uint8.raw -o out.exr --tf labels.ctbl --show-labels 1,2)
deltasplat_cli_test(parts.labels_unlisted_surface CREATES out.exr
    ARGS render cube_8x8x8_uint8.raw -o out.exr --tf labels.ctbl --isovalue 50)
foreach(mode mip min average)
    deltasplat_cli_test(parts.labels_mixed_${mode} CREATES out.png
        ARGS render cube_8x8x8_uint8.raw -o out.png --tf labels --mode ${mode}
        STDERR "deltasplat: warning: --tf: --mode ${mode} mixes values of neighbouring voxels, so that between labels it shows others that are not there; composite keeps them apart")
endforeach()
deltasplat_cli_test(parts.labels_divided CREATES out.png
    ARGS render cube_8x8x8_uint8.raw -o out.png --tf labels --between 1
    STDERR "deltasplat: warning: --tf: --between 1 mixes values of neighbouring voxels, so that between labels it shows others that are not there; --between 0 keeps them apart")
# A file may say so itself.
deltasplat_cli_test(parts.labels_of_file CREATES out.png
    ARGS render cube_labels.nhdr -o out.png --mode mip
    STDERR "deltasplat: warning: cube_labels.nhdr: --mode mip mixes values of neighbouring voxels, so that between labels it shows others that are not there; composite keeps them apart")
deltasplat_cli_test(parts.labels_converted CREATES out.nrrd
    ARGS convert cube_labels.nhdr out.nrrd STDERR "")
deltasplat_cli_test(parts.labels_held CREATES out.vdb
    ARGS delta cube_labels.nhdr out.vdb --tolerance-value 50
    STDERR "deltasplat: warning: out.vdb: has other labels than the input, taken for quantities")
deltasplat_cli_test(parts.labels_of_surface CREATES out.png
    ARGS render cube_labels.nhdr -o out.png --isovalue 50
    STDERR "deltasplat: warning: cube_labels.nhdr: a surface takes labels for quantities; without it --show-labels shows some of them")
deltasplat_cli_test(parts.labels_of_xray CREATES out.exr
    ARGS render cube_8x8x8_uint8.raw -o out.exr --mode xray --tf labels.ctbl --hide-labels 1
    STDERR "deltasplat: warning: --tf: has no effect with --mode xray
deltasplat: warning: --hide-labels: has no effect with --mode xray")
deltasplat_cli_test(parts.empty_volume CREATES out.exr
    ARGS render empty.vdb -o out.exr --crop 0:1,0:1,0:1
    STDERR_MATCHES "deltasplat: warning: empty.vdb: .*no active voxels.*")
