// Figures of one picture by their names. A run of thousands of frames keeps them for each, so they take no more room
// than they must.
#pragma once
#include <algorithm>
#include <initializer_list>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace aa {

// Sorted by name. The names are those of the table of metrics (metrics/metric.h) or literals: they are not copied.
class FigureValues {
    using Value = std::pair<std::string_view, double>;
    template <class Values>
    static auto place(Values& values, std::string_view name) {
        return std::lower_bound(values.begin(), values.end(), name,
                                [](const Value& v, std::string_view n) { return v.first < n; });
    }

  public:
    FigureValues() = default;
    FigureValues(std::initializer_list<Value> values) {
        for (const auto& [name, value] : values) (*this)[name] = value;
    }
    auto begin() const { return values_.begin(); }
    auto end() const { return values_.end(); }
    auto begin() { return values_.begin(); }
    auto end() { return values_.end(); }
    auto find(std::string_view name) const {
        const auto at = place(values_, name);
        return at != end() && at->first == name ? at : end();
    }
    // Throws std::out_of_range: it was not measured.
    double at(std::string_view name) const {
        if (const auto found = find(name); found != end()) return found->second;
        throw std::out_of_range(std::string(name));
    }
    double& operator[](std::string_view name) { return emplace(name, 0.0); }
    // Where it has no value yet.
    double& emplace(std::string_view name, double value) {
        auto at = place(values_, name);
        if (at == values_.end() || at->first != name) at = values_.insert(at, {name, value});
        return at->second;
    }
    bool operator==(const FigureValues&) const = default;
    template <class Is>
    void eraseIf(const Is& is) {
        std::erase_if(values_, is);
    }

  private:
    std::vector<Value> values_;
};

}  // namespace aa
