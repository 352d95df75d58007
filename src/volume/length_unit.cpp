// SPDX-License-Identifier: Apache-2.0
#include "volume/length_unit.h"

#include <array>
#include <initializer_list>
#include <string_view>

#include "base/text.h"

namespace deltasplat {
namespace {

struct Unit {
    const char* name;  // as Volume::lengthUnit has it
    double millimetres;
    std::initializer_list<std::string_view> spellings;  // others, in lower case
};

// The sign for micro is two characters of Unicode, and one byte of Latin-1; so is the angstrom's.
const std::array<Unit, 11>& units() {
    static const std::array<Unit, 11> kUnits{{
        {"km", 1e6, {"kilometer", "kilometers", "kilometre", "kilometres"}},
        {"m", 1e3, {"meter", "meters", "metre", "metres"}},
        {"dm", 1e2, {"decimeter", "decimeters", "decimetre", "decimetres"}},
        {"cm", 10, {"centimeter", "centimeters", "centimetre", "centimetres"}},
        {"mm", 1, {"millimeter", "millimeters", "millimetre", "millimetres"}},
        {"um",
         1e-3,
         {"micron", "microns", "micrometer", "micrometers", "micrometre", "micrometres",
          "\xc2\xb5m", "\xce\xbcm", "\xb5m", "\\u00b5m", "\\u03bcm"}},
        {"nm", 1e-6, {"nanometer", "nanometers", "nanometre", "nanometres"}},
        {"pm", 1e-9, {"picometer", "picometers", "picometre", "picometres"}},
        {"angstrom",
         1e-7,
         {"angstroms", "\xc3\xa5", "\xc3\x85", "\xe2\x84\xab", "\xc5", "\xc3\x85ngstrom"}},
        {"in", 25.4, {"inch", "inches"}},
        {"ft", 304.8, {"foot", "feet"}},
    }};
    return kUnits;
}

}  // namespace

std::string lengthUnitNamed(const std::string& text) {
    const std::string word = lowerCase(text);
    for (const Unit& unit : units()) {
        if (word == unit.name) return unit.name;
        for (const std::string_view spelling : unit.spellings) {
            if (word == spelling) return unit.name;
        }
    }
    return "";
}

double millimetresIn(const std::string& lengthUnit) {
    for (const Unit& unit : units()) {
        if (lengthUnit == unit.name) return unit.millimetres;
    }
    return 0;
}

}  // namespace deltasplat
