set(DELTASPLAT_SCENE_SOURCES property/test_scene.cpp reference/reference_renderer.cpp)
deltasplat_test(property/reference_test.cpp SOURCES ${DELTASPLAT_SCENE_SOURCES})
deltasplat_test(property/slab_test.cpp SOURCES ${DELTASPLAT_SCENE_SOURCES})
deltasplat_test(property/between_test.cpp SOURCES ${DELTASPLAT_SCENE_SOURCES})
deltasplat_test(property/placement_test.cpp SOURCES ${DELTASPLAT_SCENE_SOURCES})
deltasplat_test(property/float_values_test.cpp)
deltasplat_test(property/rays_test.cpp SOURCES ${DELTASPLAT_SCENE_SOURCES})
deltasplat_test(property/picture_place_test.cpp)
deltasplat_test(property/prepared_test.cpp)
deltasplat_test(property/perspective_test.cpp
    SOURCES ${DELTASPLAT_SCENE_SOURCES} reference/ray_marcher.cpp)
deltasplat_test(property/rays_reference_test.cpp
    SOURCES ${DELTASPLAT_SCENE_SOURCES} reference/reference_rays.cpp)
