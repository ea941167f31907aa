/// Where components hand in what they decide: the host's side of plab/levels.h.
#pragma once

#include "simulation/levels/level_book.h"

namespace plab::simulation
{

class LevelBook::Desk final : public LevelControl, public ViewpointSink, public RequestSink
{
public:
    Desk(const LevelBook& book, const MeasureError& error) : book_(book), error_(error) {}

    /// The calls that follow come from this component.
    void serve(std::uint32_t component);
    /// The component's command failed.
    void refuse(const std::string& why, EventSink& events, double time, Tick tick) const;
    std::vector<Decision> take() { return std::move(decisions_); }

    // ViewpointSink
    void add(Row row, const Viewpoint& viewpoint) override;

    // LevelControl
    std::int32_t levels(Row row) const override;
    std::span<const GovernedComponent> watched(Row row) override;
    std::span<const Viewpoint> viewpoints() const override { return viewpoints_; }
    std::string_view id_of(std::uint32_t component) const override { return book_.world_.id_of(component); }
    double error(Row row, std::size_t index, std::int32_t level, double interval) override;
    void choose(Row row, std::size_t index, std::int32_t level, std::string reason) override;

    // RequestSink
    void ask(Row row, std::string_view verb, std::string_view target, std::string_view argument, std::string reason) override;

private:
    const LevelBook& book_;
    const MeasureError& error_;
    std::uint32_t by_ = kNoIndex;
    const Governor* governor_ = nullptr;  ///< null: the component watches nothing
    bool chose_ = false;                  ///< the last decision has choices of this component
    std::vector<Viewpoint> viewpoints_;
    std::vector<GovernedComponent> looked_;
    std::vector<Decision> decisions_;
};

}  // namespace plab::simulation
