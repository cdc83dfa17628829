/// The results of `bench`, and their output as tables, JSON, a page and a chart.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <hedgerow/measure/engine.h>

#include "report/table.h"

namespace hedgerow::cli {

struct BenchReport {
    std::string processor, avx512_rate, compiler, instruction_set;
    unsigned cores = 0;
    double gigahertz = 0;  ///< clock rate while one thread computes
    int width = 0;         ///< children a node
    unsigned threads = 1;
    measure::EngineOptions options;
    struct PeerFacts {
        std::string name, version;
        std::vector<std::string> builds;
    };
    std::vector<PeerFacts> peers;
    std::vector<measure::SceneCosts> scenes;
    std::vector<std::string> notes;  ///< facts that a reader of the figures must know
    bool finished = true;

    /// Cycles per visit of our fastest tree, as a multiple of the least that is possible (floor_of).
    double times_floor(const measure::Row& row) const;
};

/// Million rays a second.
constexpr double mrays(double seconds_a_ray) {
    return 1e-6 / seconds_a_ray;
}

/// One line about the machine, the build and the peers: "AMD EPYC, 2 cores, ...".
std::string machine_of(const BenchReport& report);
std::vector<Table> tables_of(const BenchReport& report);
nlohmann::ordered_json json_of(const BenchReport& report);
/// An HTML page with plots, which needs no other file.
std::string page_of(const BenchReport& report);
/// An SVG chart of our rates and the peers', by ray set and scene.
std::string chart_of(const BenchReport& report);

/// Names of rows, as "primary, closest, one", and of the peers' rates, as "Embree medium".
std::string name_of(const measure::Row& row);
std::string name_of(const measure::TheirRate& rate);

}  // namespace hedgerow::cli
