// SPDX-License-Identifier: BSD-3-Clause
#include "lib/cholesky.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>

namespace meshpipe {
namespace {

using Complex = std::complex<double>;

// Products without the library's care for infinities, which costs more than the product.
double times(double a, double b) { return a * b; }
Complex times(Complex a, Complex b) {
  return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}
double conjugate(double a) { return a; }
Complex conjugate(Complex a) { return std::conj(a); }

/// The row of the first entry below the diagonal of each column of the factor (Liu 1990); -1: none.
std::vector<int> elimination_tree(const Pattern& pattern, const std::vector<int>& order,
                                  const std::vector<int>& place) {
  int n = pattern.rows();
  std::vector<int> parent(n, -1), ancestor(n, -1);
  for (int k = 0; k < n; ++k)
    for (int e = pattern.start[order[k]]; e < pattern.start[order[k] + 1]; ++e)
      for (int i = place[pattern.neighbour[e]]; i >= 0 && i < k;) {
        int up = ancestor[i];
        ancestor[i] = k;
        if (up < 0) parent[i] = k;
        i = up;
      }
  return parent;
}

/// The nodes of a forest, children before their parent and every subtree in one piece.
std::vector<int> postorder(const std::vector<int>& parent) {
  int n = (int)parent.size();
  std::vector<int> child(n, -1), sibling(n, -1), order, stack;
  order.reserve(n);
  for (int v = n - 1; v >= 0; --v)
    if (parent[v] >= 0) {
      sibling[v] = child[parent[v]];
      child[parent[v]] = v;
    }
  for (int root = 0; root < n; ++root) {
    if (parent[root] >= 0) continue;
    stack.push_back(root);
    while (!stack.empty()) {
      int v = stack.back();
      if (child[v] >= 0) {
        stack.push_back(child[v]);
        child[v] = sibling[child[v]];
      } else {
        order.push_back(v);
        stack.pop_back();
      }
    }
  }
  return order;
}

std::vector<int> inverse(const std::vector<int>& order) {
  std::vector<int> place(order.size());
  for (int k = 0; k < (int)order.size(); ++k) place[order[k]] = k;
  return place;
}

/// Entries below the diagonal of each column of the factor: row by row, the part of the tree between the
/// row's entries and the diagonal.
std::vector<int> column_counts(const Pattern& pattern, const Supernodes& nodes,
                               const std::vector<int>& parent) {
  int n = pattern.rows();
  std::vector<int> count(n, 0), seen(n, -1);
  for (int k = 0; k < n; ++k) {
    seen[k] = k;
    int row = nodes.order[k];
    for (int e = pattern.start[row]; e < pattern.start[row + 1]; ++e)
      for (int i = nodes.place[pattern.neighbour[e]]; i < k && seen[i] != k; i = parent[i]) {
        ++count[i];
        seen[i] = k;
      }
  }
  return count;
}

/// Groups columns whose rows are the same, and then a group with the one that follows if that is its parent
/// and the zeros that it has to store are few (Ashcraft and Grimes 1989).
std::vector<int> group_columns(const std::vector<int>& parent, const std::vector<int>& count) {
  struct Group {
    int first, last;
    double zeros;
  };
  std::vector<Group> groups;
  for (int k = 0; k < (int)parent.size(); ++k) {
    if (!groups.empty() && parent[k - 1] == k && count[k - 1] == count[k] + 1)
      groups.back().last = k;
    else
      groups.push_back({k, k, 0});
    if (k + 1 < (int)parent.size() && parent[k] == k + 1 && count[k] == count[k + 1] + 1) continue;
    while (groups.size() > 1) {
      Group &a = groups[groups.size() - 2], &b = groups.back();
      if (parent[a.last] < b.first || parent[a.last] > b.last) break;
      double wide_a = a.last - a.first + 1, wide_b = b.last - b.first + 1, wide = wide_a + wide_b;
      double zeros = a.zeros + b.zeros + wide_a * (wide_b + count[b.last] - count[a.last]);
      double share = zeros / (0.5 * wide * (wide + 1) + wide * count[b.last]);
      if (!(wide <= 4 || share < (wide <= 16 ? 0.5 : wide <= 48 ? 0.1 : 0.05))) break;
      a = {a.first, b.last, zeros};
      groups.pop_back();
    }
  }
  std::vector<int> first;
  for (const Group& g : groups) first.push_back(g.first);
  first.push_back((int)parent.size());
  return first;
}

/// Columns of a block at a time; a block of this many columns is factorised by columns.
constexpr int block = 32;

/// c -= a b^H for a of `rows` x `depth` and b of `columns` x `depth`, all by columns, `step` apart.
template <class Scalar>
void subtract_product(Scalar* c, int c_step, int rows, int columns, const Scalar* a, int a_step,
                      const Scalar* b, int b_step, int depth) {
  constexpr int tile = 128;  // rows that stay in the first cache with four columns of c
  for (int i0 = 0; i0 < rows; i0 += tile) {
    int m = std::min(tile, rows - i0), j = 0;
    for (; j + 1 < columns; j += 2) {
      Scalar *c0 = c + i0 + (std::size_t)j * c_step, *c1 = c0 + c_step;
      int p = 0;
      for (; p + 3 < depth; p += 4) {
        const Scalar *a0 = a + i0 + (std::size_t)p * a_step, *a1 = a0 + a_step, *a2 = a1 + a_step,
                     *a3 = a2 + a_step;
        const Scalar* q = b + j + (std::size_t)p * b_step;
        Scalar q00 = conjugate(q[0]), q01 = conjugate(q[1]);
        Scalar q10 = conjugate(q[b_step]), q11 = conjugate(q[b_step + 1]);
        Scalar q20 = conjugate(q[2 * b_step]), q21 = conjugate(q[2 * b_step + 1]);
        Scalar q30 = conjugate(q[3 * b_step]), q31 = conjugate(q[3 * b_step + 1]);
#pragma omp simd
        for (int i = 0; i < m; ++i) {
          c0[i] -= (times(a0[i], q00) + times(a1[i], q10)) + (times(a2[i], q20) + times(a3[i], q30));
          c1[i] -= (times(a0[i], q01) + times(a1[i], q11)) + (times(a2[i], q21) + times(a3[i], q31));
        }
      }
      for (; p < depth; ++p) {
        const Scalar* a0 = a + i0 + (std::size_t)p * a_step;
        const Scalar* q = b + j + (std::size_t)p * b_step;
        Scalar q0 = conjugate(q[0]), q1 = conjugate(q[1]);
#pragma omp simd
        for (int i = 0; i < m; ++i) {
          c0[i] -= times(a0[i], q0);
          c1[i] -= times(a0[i], q1);
        }
      }
    }
    if (j < columns)
      for (int p = 0; p < depth; ++p) {
        Scalar* c0 = c + i0 + (std::size_t)j * c_step;
        const Scalar* a0 = a + i0 + (std::size_t)p * a_step;
        Scalar q = conjugate(b[j + (std::size_t)p * b_step]);
#pragma omp simd
        for (int i = 0; i < m; ++i) c0[i] -= times(a0[i], q);
      }
  }
}

/// The same of a matrix with itself, c's lower triangle; what is above it is not to be used.
template <class Scalar>
void subtract_square(Scalar* c, int c_step, int rows, const Scalar* a, int a_step, int depth) {
  for (int j = 0; j < rows; j += block)
    subtract_product(c + j + (std::size_t)j * c_step, c_step, rows - j, std::min(block, rows - j), a + j,
                     a_step, a + j, a_step, depth);
}

}  // namespace

Supernodes find_supernodes(const Pattern& pattern, std::vector<int> order) {
  int n = pattern.rows();
  Supernodes nodes;
  nodes.place = inverse(order);
  std::vector<int> parent = elimination_tree(pattern, order, nodes.place), post = postorder(parent);
  std::vector<int> number = inverse(post), renumbered(n);
  for (int k = 0; k < n; ++k) {
    renumbered[k] = parent[post[k]] < 0 ? -1 : number[parent[post[k]]];
    nodes.order.push_back(order[post[k]]);
  }
  parent.swap(renumbered);
  nodes.place = inverse(nodes.order);
  nodes.first = group_columns(parent, column_counts(pattern, nodes, parent));

  int n_groups = nodes.size();
  std::vector<int> group(n), seen(n, -1), up(n_groups, -1);
  for (int s = 0; s < n_groups; ++s)
    for (int k = nodes.first[s]; k < nodes.first[s + 1]; ++k) group[k] = s;
  // the first row below a group is the parent of its last column
  nodes.child_start.assign(n_groups + 1, 0);
  for (int s = 0; s < n_groups; ++s)
    if (int k = parent[nodes.first[s + 1] - 1]; k >= 0) ++nodes.child_start[(up[s] = group[k]) + 1];
  std::partial_sum(nodes.child_start.begin(), nodes.child_start.end(), nodes.child_start.begin());
  nodes.child.resize(nodes.child_start.back());
  std::vector<int> at(nodes.child_start.begin(), nodes.child_start.end() - 1);
  for (int s = 0; s < n_groups; ++s)
    if (up[s] >= 0) nodes.child[at[up[s]]++] = s;

  nodes.row_start.assign(1, 0);
  nodes.value_start.assign(1, 0);
  std::size_t waiting = 0;
  for (int s = 0; s < n_groups; ++s) {
    auto add = [&](int k) {
      if (k < nodes.first[s + 1] || seen[k] == s) return;
      seen[k] = s;
      nodes.rows.push_back(k);
    };
    std::size_t freed = 0;
    for (int c = nodes.child_start[s]; c < nodes.child_start[s + 1]; ++c) {
      int t = nodes.child[c];
      freed += (std::size_t)nodes.below(t) * nodes.below(t);
      for (int r = nodes.row_start[t]; r < nodes.row_start[t + 1]; ++r) add(nodes.rows[r]);
    }
    for (int k = nodes.first[s]; k < nodes.first[s + 1]; ++k)
      for (int e = pattern.start[nodes.order[k]]; e < pattern.start[nodes.order[k] + 1]; ++e)
        add(nodes.place[pattern.neighbour[e]]);
    std::sort(nodes.rows.begin() + nodes.row_start[s], nodes.rows.end());
    nodes.row_start.push_back((int)nodes.rows.size());
    std::size_t r = nodes.below(s), w = nodes.width(s);
    nodes.value_start.push_back(nodes.value_start.back() + w * (w + r));
    nodes.most_waiting = std::max(nodes.most_waiting, waiting + r * r);
    waiting += r * r - freed;
  }
  return nodes;
}

template <class Scalar>
void Cholesky<Scalar>::factorise(const std::vector<Entry<Scalar>>& entries, double least) {
  // the entries by their columns in the order of elimination
  int n = (int)nodes_.order.size();
  std::vector<int> start(n + 1, 0), local(n);
  auto column = [&](const Entry<Scalar>& e) { return std::min(nodes_.place[e.row], nodes_.place[e.col]); };
  for (const auto& e : entries) ++start[column(e) + 1];
  std::partial_sum(start.begin(), start.end(), start.begin());
  std::vector<std::pair<int, Scalar>> sorted(entries.size());
  for (const auto& e : entries) {
    int i = nodes_.place[e.row], j = nodes_.place[e.col];
    // above the diagonal in the new order: its mirror image is below
    sorted[start[std::min(i, j)]++] = {std::max(i, j), i < j ? conjugate(e.value) : e.value};
  }

  value_.assign(nodes_.value_start.back(), Scalar(0));
  std::vector<Scalar> waiting(nodes_.most_waiting);
  std::vector<double> given;  // of a front's diagonal
  std::size_t top = 0;
  for (int s = 0, entry = 0; s < nodes_.size(); ++s) {
    const int w = nodes_.width(s), r = nodes_.below(s), m = w + r, k0 = nodes_.first[s];
    const int* rows = nodes_.rows.data() + nodes_.row_start[s];
    for (int j = 0; j < w; ++j) local[k0 + j] = j;
    for (int i = 0; i < r; ++i) local[rows[i]] = w + i;
    Scalar* front = value_.data() + nodes_.value_start[s];
    Scalar* update = waiting.data() + top;
    std::fill(update, update + (std::size_t)r * r, Scalar(0));
    double diagonal[block];
    for (int j = 0; j < w; ++j)
      for (; entry < start[k0 + j]; ++entry)
        front[local[sorted[entry].first] + (std::size_t)j * m] += sorted[entry].second;
    given.resize(w);
    for (int j = 0; j < w; ++j) given[j] = std::real(front[j + (std::size_t)j * m]);

    // the updates of the children lie below, in their order
    std::size_t bottom = top;
    for (int c = nodes_.child_start[s + 1] - 1; c >= nodes_.child_start[s]; --c) {
      int t = nodes_.child[c], size = nodes_.below(t);
      const int* from = nodes_.rows.data() + nodes_.row_start[t];
      bottom -= (std::size_t)size * size;
      for (int j = 0; j < size; ++j) {
        const Scalar* a = waiting.data() + bottom + (std::size_t)j * size;
        int to = local[from[j]];
        Scalar* b = to < w ? front + (std::size_t)to * m : update + (std::size_t)(to - w) * r - w;
        for (int i = j; i < size; ++i) b[local[from[i]]] += a[i];
      }
    }

    for (int j0 = 0; j0 < w; j0 += block) {
      int wide = std::min(block, w - j0), end = j0 + wide;
      Scalar* corner = front + j0 + (std::size_t)j0 * m;
      for (int j = 0; j < wide; ++j) {
        Scalar* c = corner + (std::size_t)j * m;
        subtract_product(c + j, m, wide - j, 1, corner + j, m, corner + j, m, j);
        double pivot = std::real(c[j]);
        if (!(pivot > least * given[j0 + j]) || !std::isfinite(pivot))
          throw Singular{nodes_.order[k0 + j0 + j], given[j0 + j], pivot};
        double root = std::sqrt(pivot);
        c[j] = root;
        diagonal[j] = 1 / root;
        for (int i = j + 1; i < wide; ++i) c[i] *= diagonal[j];
      }
      for (int j = 0; j < wide; ++j) {
        Scalar* c = corner + (std::size_t)j * m;
        subtract_product(c + wide, m, m - end, 1, corner + wide, m, corner + j, m, j);
        for (int i = wide; i < m - j0; ++i) c[i] *= diagonal[j];
      }
      // the columns of the front that are left, their diagonal blocks included
      for (int j = end; j < w; j += block)
        subtract_product(front + j + (std::size_t)j * m, m, m - j, std::min(block, w - j),
                         front + j + (std::size_t)j0 * m, m, front + j + (std::size_t)j0 * m, m, wide);
    }
    subtract_square(update, r, r, front + w, m, w);
    std::copy(update, update + (std::size_t)r * r, waiting.data() + bottom);
    top = bottom + (std::size_t)r * r;
  }
}

template <class Scalar>
void Cholesky<Scalar>::solve(Scalar* x) const {
  int n = (int)nodes_.order.size();
  std::vector<Scalar> y(n), below;
  for (int k = 0; k < n; ++k) y[k] = x[nodes_.order[k]];
  for (int s = 0; s < nodes_.size(); ++s) {
    const int w = nodes_.width(s), r = nodes_.below(s), m = w + r;
    const int* rows = nodes_.rows.data() + nodes_.row_start[s];
    Scalar* top = y.data() + nodes_.first[s];
    below.assign(r, Scalar(0));
    for (int j = 0; j < w; ++j) {
      const Scalar* l = value_.data() + nodes_.value_start[s] + (std::size_t)j * m;
      Scalar value = top[j] /= l[j];
      for (int i = j + 1; i < w; ++i) top[i] -= times(l[i], value);
      for (int i = 0; i < r; ++i) below[i] += times(l[w + i], value);
    }
    for (int i = 0; i < r; ++i) y[rows[i]] -= below[i];
  }
  for (int s = nodes_.size() - 1; s >= 0; --s) {
    const int w = nodes_.width(s), r = nodes_.below(s), m = w + r;
    const int* rows = nodes_.rows.data() + nodes_.row_start[s];
    Scalar* top = y.data() + nodes_.first[s];
    below.resize(r);
    for (int i = 0; i < r; ++i) below[i] = y[rows[i]];
    for (int j = w - 1; j >= 0; --j) {
      const Scalar* l = value_.data() + nodes_.value_start[s] + (std::size_t)j * m;
      Scalar value = top[j];
      for (int i = j + 1; i < w; ++i) value -= times(conjugate(l[i]), top[i]);
      for (int i = 0; i < r; ++i) value -= times(conjugate(l[w + i]), below[i]);
      top[j] = value / l[j];
    }
  }
  for (int k = 0; k < n; ++k) x[nodes_.order[k]] = y[k];
}

template class Cholesky<double>;
template class Cholesky<Complex>;

}  // namespace meshpipe
