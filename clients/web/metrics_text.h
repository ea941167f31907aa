/// What a server says of itself, for Prometheus: its text format, version 0.0.4, in base units (seconds, joules, meters).
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "link/catalogue.h"

namespace plab::web
{

/// The figures of one moment.
struct Figures
{
    struct Component
    {
        std::string id, algorithm;
        double cost_ns = 0;  ///< of a step
        double error = 0;    ///< NaN: not known
        double work = 0;     ///< J
        bool quarantined = false;
    };
    link::ServerInfo server;
    link::Metrics metrics;  ///< without its interactions
    std::vector<Component> components;
    std::size_t bodies = 0, shafts = 0, interactions = 0;
};

Figures figures_of(const link::CatalogueContents& now);

/// Of this program.
struct PageFigures
{
    std::size_t pages = 0;
    std::uint64_t replaced = 0;      ///< poses that a newer one replaced before a page took them
    std::uint64_t times_behind = 0;  ///< pages that took nothing until they had to begin anew
};

inline constexpr std::size_t kMostComponents = 2000;  ///< with series of their own; the dearest ones
inline constexpr const char* kMetricsType = "text/plain; version=0.0.4; charset=utf-8";

/// `figures` null: there is no server.
std::string metrics_text(const Figures* figures, const PageFigures& pages);

/// The newest figures, from the thread that talks to the server to the one that serves.
class NewestFigures
{
public:
    void set(std::shared_ptr<const Figures> figures);
    std::shared_ptr<const Figures> get() const;

private:
    mutable std::mutex mutex_;
    std::shared_ptr<const Figures> figures_;
};

}  // namespace plab::web
