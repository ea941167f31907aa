/// The trajectories that plabd writes, as CSV. Columns are documented in server/docs/output.md.
#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "plab/csv.h"
#include "simulation/simulation.h"

namespace plab::daemon
{

class Trace
{
public:
    /// Writes the header. Its columns are those of the components that the scene has now.
    static Result<std::unique_ptr<Trace>> open(const std::string& file, const simulation::Simulation& simulation, double every);
    /// Writes a row if one is due; always if `last`.
    void sample(const simulation::Simulation& simulation, bool last = false);

private:
    Trace() = default;
    struct Closer
    {
        void operator()(std::FILE* f) const { std::fclose(f); }
    };
    /// A field of a component, in as many columns as its value had numbers at the start.
    struct Columns
    {
        std::string component, field;
        std::size_t count = 1;
        bool output = false;  ///< of an interaction: a component that replaces it may not have this output
    };
    void add(const simulation::Simulation& simulation, std::uint32_t component, const std::string& field, bool output, CsvRow& header);
    void write(CsvRow& row);

    std::unique_ptr<std::FILE, Closer> file_;
    std::vector<Columns> columns_;
    double every_ = 0;
    double next_ = 0;
    Tick last_ = -1;
};

}  // namespace plab::daemon
