// SPDX-License-Identifier: Apache-2.0
#include "table1/ct_ramp.h"

namespace deltasplat {

TransferFunction ctRamp() {
    TransferFunction function;
    function.name = "ct";
    function.colors = {{0.0, {0.0, 0.0, 0.0}},  {0.22, {0.2, 0.3, 0.6}}, {0.45, {0.9, 0.6, 0.3}},
                       {0.65, {0.9, 0.7, 0.4}}, {0.8, {1.0, 1.0, 0.9}},  {1.0, {1.0, 1.0, 1.0}}};
    function.opacities = {{0.0, 0.0},   {0.22, 0.0}, {0.45, 0.03},
                          {0.65, 0.03}, {0.8, 0.4},  {1.0, 0.6}};
    function.normalized = true;
    function.linearColors = true;
    return function;
}

}  // namespace deltasplat
