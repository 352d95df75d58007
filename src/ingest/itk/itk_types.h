// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "ingest/itk/itk_compiler.h"

#include <itkCommonEnums.h>

#include <optional>

#include "ingest/raw/raw_format.h"

namespace deltasplat {

/// Returns our type for one of ITK's; nothing for what is no number.
inline std::optional<RawType> rawTypeOfItk(itk::CommonEnums::IOComponent type) {
    using Type = itk::CommonEnums::IOComponent;
    constexpr bool kWide = sizeof(long) == 8;
    switch (type) {
        case Type::UCHAR:
            return RawType::kUint8;
        case Type::CHAR:
            return RawType::kInt8;
        case Type::USHORT:
            return RawType::kUint16;
        case Type::SHORT:
            return RawType::kInt16;
        case Type::UINT:
            return RawType::kUint32;
        case Type::INT:
            return RawType::kInt32;
        case Type::ULONG:
            return kWide ? RawType::kUint64 : RawType::kUint32;
        case Type::LONG:
            return kWide ? RawType::kInt64 : RawType::kInt32;
        case Type::ULONGLONG:
            return RawType::kUint64;
        case Type::LONGLONG:
            return RawType::kInt64;
        case Type::FLOAT:
            return RawType::kFloat32;
        case Type::DOUBLE:
            return RawType::kFloat64;
        default:
            return std::nullopt;
    }
}

}  // namespace deltasplat
