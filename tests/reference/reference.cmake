deltasplat_test(reference / reference_renderer_test.cpp SOURCES reference / reference_renderer.cpp)
