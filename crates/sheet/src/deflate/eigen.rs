//! Eigenvalues of small symmetric matrices.

/// Rounds of turns, at most; some six are enough.
const ROUNDS: usize = 30;

/// Eigenvalues of a symmetric matrix, ascending, and its unit eigenvectors (Jacobi's turns); `None` where something is not finite.
pub(super) fn eigen<const N: usize>(entry: impl Fn(usize, usize) -> f64) -> Option<[(f64, [f64; N]); N]> {
    let mut a: [[f64; N]; N] = std::array::from_fn(|i| std::array::from_fn(|j| entry(i.max(j), i.min(j))));
    if !a.iter().flatten().all(|x| x.is_finite()) {
        return None;
    }
    // Its rows are the vectors.
    let mut turned: [[f64; N]; N] =
        std::array::from_fn(|i| std::array::from_fn(|j| f64::from(u8::from(i == j))));
    for _ in 0..ROUNDS {
        let mut is_done = true;
        for p in 0..N {
            for q in p + 1..N {
                // Nothing that would change a digit of the values.
                if a[p][q].abs() <= f64::EPSILON * 1e-3 * (a[p][p] * a[q][q]).abs().sqrt() {
                    continue;
                }
                is_done = false;
                let cotangent = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
                let tangent = cotangent.signum() / (cotangent.abs() + (cotangent * cotangent + 1.0).sqrt());
                let cosine = 1.0 / (tangent * tangent + 1.0).sqrt();
                let sine = tangent * cosine;
                for row in &mut a {
                    (row[p], row[q]) = (cosine * row[p] - sine * row[q], sine * row[p] + cosine * row[q]);
                }
                for rows in [&mut a, &mut turned] {
                    let (x, y) = (rows[p], rows[q]);
                    rows[p] = std::array::from_fn(|k| cosine * x[k] - sine * y[k]);
                    rows[q] = std::array::from_fn(|k| sine * x[k] + cosine * y[k]);
                }
                (a[p][q], a[q][p]) = (0.0, 0.0);
            }
        }
        if is_done {
            break;
        }
    }
    let mut found: [(f64, [f64; N]); N] = std::array::from_fn(|k| (a[k][k], turned[k]));
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    Some(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vectors_are_turned_into_multiples_of_themselves() {
        // Hilbert's matrix, of condition 1.5e7.
        let entry = |i: usize, j: usize| 1.0 / (i + j + 1) as f64;
        let found = eigen::<6>(entry).unwrap_or_default();
        assert!(found.is_sorted_by_key(|f| f.0) && (found[0].0 - 1.082_799_484_5e-7).abs() < 1e-15);
        for (value, vector) in &found {
            assert!((vector.iter().map(|x| x * x).sum::<f64>() - 1.0).abs() < 1e-14);
            for i in 0..6 {
                let product: f64 = (0..6).map(|j| entry(i, j) * vector[j]).sum();
                assert!((product - value * vector[i]).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn what_is_not_finite_has_none() {
        assert!(eigen::<3>(|i, j| if i == j { 1.0 } else { f64::NAN }).is_none());
        assert_eq!(eigen::<2>(|_, _| 0.0).map(|e| e[1].0), Some(0.0));
    }
}
