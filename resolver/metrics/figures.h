// Figures of one picture by their names. A run of thousands of frames keeps them for each, so they take no more room
// than they must: the names are kept once for all that have the same.
#pragma once
#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <iterator>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace aa {

// Sorted by name. The names are those of the table of metrics (metrics/metric.h) or literals: they are not copied.
class FigureValues {
    using Names = std::vector<std::string_view>;

    template <class Double>
    struct Entry {
        std::string_view first;
        Double& second;
        template <class Other>
        bool operator==(const Entry<Other>& o) const {
            return first == o.first && second == o.second;
        }
        Entry* operator->() { return this; }
    };
    template <class Double>
    class Iterator {
      public:
        using iterator_category = std::input_iterator_tag;
        using value_type = Entry<Double>;
        using difference_type = ptrdiff_t;
        using pointer = value_type;
        using reference = value_type;
        Iterator(const std::string_view* name, Double* value) : name_(name), value_(value) {}
        value_type operator*() const { return {*name_, *value_}; }
        value_type operator->() const { return **this; }
        Iterator& operator++() {
            name_++, value_++;
            return *this;
        }
        Iterator operator++(int) { return {name_++, value_++}; }
        bool operator==(const Iterator& o) const { return value_ == o.value_; }

      private:
        const std::string_view* name_;
        Double* value_;
    };

  public:
    FigureValues() = default;
    FigureValues(const FigureValues&) = default;
    FigureValues& operator=(const FigureValues&) = default;
    FigureValues(FigureValues&& o) noexcept { *this = std::move(o); }
    FigureValues& operator=(FigureValues&& o) noexcept {
        std::swap(names_, o.names_), std::swap(values_, o.values_);
        return *this;
    }
    FigureValues(std::initializer_list<std::pair<std::string_view, double>> values) {
        for (const auto& [name, value] : values) (*this)[name] = value;
    }
    auto begin() const { return Iterator<const double>(names_->data(), values_.data()); }
    auto end() const { return Iterator<const double>(names_->data() + size(), values_.data() + size()); }
    auto begin() { return Iterator<double>(names_->data(), values_.data()); }
    auto end() { return Iterator<double>(names_->data() + size(), values_.data() + size()); }
    size_t size() const { return values_.size(); }
    auto find(std::string_view name) const {
        const size_t at = place(name);
        return has(name, at) ? Iterator<const double>(names_->data() + at, values_.data() + at) : end();
    }
    // Throws std::out_of_range: it was not measured.
    double at(std::string_view name) const {
        if (const size_t at = place(name); has(name, at)) return values_[at];
        throw std::out_of_range(std::string(name));
    }
    double& operator[](std::string_view name) { return emplace(name, 0.0); }
    // Where it has no value yet.
    double& emplace(std::string_view name, double value) {
        const size_t at = place(name);
        if (!has(name, at)) {
            Names names = *names_;
            names.insert(names.begin() + ptrdiff_t(at), name);
            names_ = kept(std::move(names));
            values_.insert(values_.begin() + ptrdiff_t(at), value);
        }
        return values_[at];
    }
    bool operator==(const FigureValues&) const = default;  // names that are equal are the same
    template <class Is>
    void eraseIf(const Is& is) {
        FigureValues rest;
        for (const auto entry : std::as_const(*this))
            if (!is(entry)) rest[entry.first] = entry.second;
        *this = std::move(rest);
    }

  private:
    size_t place(std::string_view name) const {
        return size_t(std::lower_bound(names_->begin(), names_->end(), name) - names_->begin());
    }
    bool has(std::string_view name, size_t at) const { return at < size() && (*names_)[at] == name; }
    // The one list of these names that is kept as long as the program runs. Thread-safe.
    static const Names* kept(Names names);

    const Names* names_ = kept({});
    std::vector<double> values_;
};

}  // namespace aa
