// SPDX-License-Identifier: Apache-2.0
#include "bench/bench_json.h"
#include "table1/table1.h"
#include "text/json_text.h"

namespace deltasplat {

std::string jsonText(const Table1Report& report) {
    using Json = nlohmann::ordered_json;
    Json rows = Json::array();
    for (const Table1Row& row : report.rows) {
        rows.push_back({{"data_set", row.dataSet.name},
                        {"paper", row.dataSet.paper},
                        {"stand_in", row.dataSet.standIn},
                        {"exact", runJson(row.exact)},
                        {"tolerance_value_2", runJson(row.held)}});
    }
    return dumpJson({{"machine", machineJson(report.machine)}, {"table1", rows}});
}

}  // namespace deltasplat
