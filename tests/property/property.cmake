# What holds of all pictures, tried on volumes and cameras at random.
deltasplat_tests(reference_tests property
    reference/reference_renderer_test.cpp
    property/between_test.cpp property/color_by_test.cpp property/delta_file_test.cpp
    property/perspective_test.cpp property/placement_test.cpp property/ray_modes_test.cpp
    property/rays_test.cpp property/rays_reference_test.cpp property/reference_test.cpp
    property/shading_test.cpp property/slab_test.cpp
    SOURCES
    property/test_scene.cpp reference/plain_delta_reader.cpp reference/ray_marcher.cpp
    reference/reference_rays.cpp reference/reference_renderer.cpp)

deltasplat_tests(picture_tests property
    property/aov_depths_test.cpp property/aov_mattes_test.cpp property/aov_normals_test.cpp
    property/aovs_test.cpp property/deep_test.cpp property/far_groups_test.cpp
    property/ground_shadow_test.cpp property/picture_test.cpp property/picture_place_test.cpp
    property/prepared_test.cpp property/slab_files_test.cpp property/slab_picture_test.cpp)

deltasplat_tests(look_tests property
    property/cut_test.cpp property/delta_leaves_test.cpp property/float_values_test.cpp
    property/gradient_opacity_test.cpp property/identity_test.cpp property/joined_test.cpp
    property/level_set_test.cpp property/medium_test.cpp property/point_light_test.cpp
    property/scattering_test.cpp property/surface_test.cpp property/thin_test.cpp
    property/tolerance_test.cpp property/wide_voxels_test.cpp)
# GCC 12 does not see at -O1 that copies of a list's lights are whole.
set_property(SOURCE property/shading_test.cpp APPEND PROPERTY COMPILE_OPTIONS -Wno-maybe-uninitialized)
