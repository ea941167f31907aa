/// What plabd writes: the end state as JSON, the course as CSV.
#pragma once

#include <cstdio>
#include <memory>
#include <string>

#include "simulation/simulation.h"

namespace plab::daemon
{

/// The state of the scene as JSON; numbers with 17 significant digits. Keys are documented in server/docs/output.md.
std::string end_state_json(const simulation::Simulation& simulation);

/// Writes it to a file; "-" is standard output. False if that failed; the log says why.
bool write_end_state(const simulation::Simulation& simulation, const std::string& file);

/// Rows of the same figures over time.
class Trace
{
public:
    /// Writes the header. Columns are those of the objects that the scene has now.
    static Result<std::unique_ptr<Trace>> open(const std::string& file, const simulation::Simulation& simulation, double every);
    /// A row if the time for one has come; always if `last`.
    void sample(const simulation::Simulation& simulation, bool last = false);

private:
    Trace() = default;
    struct Closer
    {
        void operator()(std::FILE* f) const { std::fclose(f); }
    };
    std::unique_ptr<std::FILE, Closer> file_;
    std::vector<std::pair<std::string, std::size_t>> objects_;  ///< id and number of columns
    double every_ = 0;
    double next_ = 0;
    Tick last_ = -1;
};

}  // namespace plab::daemon
