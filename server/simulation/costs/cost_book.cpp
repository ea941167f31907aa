#include "simulation/costs/cost_book.h"

#include <numeric>

namespace plab::simulation
{

void CostAccounts::clear()
{
    std::fill(by_component.begin(), by_component.end(), 0);
    std::fill(by_table.begin(), by_table.end(), 0);
    host = 0;
}

CostAccounts& CostAccounts::operator+=(const CostAccounts& other)
{
    fit(std::max(by_component.size(), other.by_component.size()), std::max(by_table.size(), other.by_table.size()));
    for (std::size_t i = 0; i < other.by_component.size(); ++i) by_component[i] += other.by_component[i];
    for (std::size_t t = 0; t < other.by_table.size(); ++t) by_table[t] += other.by_table[t];
    for (std::size_t t = 0; t < other.phases.size(); ++t) phases[t] |= other.phases[t];
    host += other.host;
    return *this;
}

std::int64_t CostAccounts::sum() const
{
    const auto add = [](std::int64_t from, const std::vector<std::int64_t>& all) { return std::accumulate(all.begin(), all.end(), from); };
    return add(add(host, by_component), by_table);
}

Spread CostWindow::spread() const
{
    std::array<double, kLength> values;
    std::copy(ns_.begin(), ns_.begin() + count_, values.begin());
    return spread_of(std::span(values.data(), count_));
}

void CostBook::rebuild(std::span<const std::uint32_t> owners, std::size_t tables)
{
    own_.resize(owners.size());
    owners_.clear();
    for (std::uint32_t i = 0; i < owners.size(); ++i)
    {
        if (owners[i] == kNone)
            own_[i].reset();
        else if (!own_[i] || own_[i]->table != owners[i])
            own_[i] = std::make_unique<Account>(Account{owners[i], 0, {}});
        if (own_[i]) owners_.push_back(i);
    }
    tables_.resize(tables);
}

void CostBook::book(CostAccounts& accounts)
{
    const auto sum = static_cast<double>(accounts.sum());
    total_ += sum, host_total_ += static_cast<double>(accounts.host);
    step_.push(sum), host_.push(static_cast<double>(accounts.host));
    ++steps_;
    const auto add = [](Account& account, std::int64_t ns)
    { account.total += static_cast<double>(ns), account.window.push(static_cast<double>(ns)); };
    for (const std::uint32_t i : owners_)
        if (own_[i] && i < accounts.by_component.size()) add(*own_[i], accounts.by_component[i]);
    for (std::size_t t = 0; t < tables_.size() && t < accounts.by_table.size(); ++t) add(tables_[t], accounts.by_table[t]);
    accounts.clear();
}

}  // namespace plab::simulation
