/// What `bench` found, and the ways to say it: tables, JSON, a page, a chart.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "measure/engine.h"
#include "table.h"

namespace hedgerow::cli {

struct BenchReport {
    std::string processor, compiler, instruction_set;
    unsigned cores = 0;
    double gigahertz = 0;  ///< while one thread computes
    int width = 0;         ///< children a node
    unsigned threads = 1;
    benchmark::EngineOptions options;
    struct PeerFacts {
        std::string name, version;
        std::vector<std::string> builds;
    };
    std::vector<PeerFacts> peers;
    std::vector<benchmark::SceneCosts> scenes;
    std::vector<std::string> notes;  ///< what a reader of the figures must know
    bool finished = true;

    /// How many times the least that is possible a visit of our fastest tree takes.
    double times_floor(const benchmark::Row& row) const;
};

/// "AMD EPYC, 2 cores, ...": a line.
std::string machine_of(const BenchReport& report);
std::vector<Table> tables_of(const BenchReport& report);
nlohmann::ordered_json json_of(const BenchReport& report);
/// One file, with plots, that needs no other.
std::string page_of(const BenchReport& report);
/// One picture: rates by ray set and scene, ours and theirs.
std::string chart_of(const BenchReport& report);

/// "closest, one", "Embree medium": how rows and trees are named.
std::string name_of(const benchmark::Row& row);
std::string name_of(const benchmark::TheirRate& rate);

}  // namespace hedgerow::cli
