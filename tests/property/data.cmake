deltasplat_test(property/axis_change_test.cpp LABELS data)
