//! Gauss-Newton over parameters and nodes: each segment's node is eliminated (Schur complement), so that the
//! work grows with the number of segments only.

use super::error::RefitError;
use super::parameters::Unknowns;
use super::segments::{STATE, Segment, Shooter};
use super::settings::RefitSettings;
use crate::compare::StateNoise;
use crate::diagnose::trace::Trace;
use nalgebra::{Const, DMatrix, DVector, Dyn, OMatrix, SMatrix, SVector};
use rayon::prelude::*;

/// Where it ended.
pub(super) struct Solution {
    pub(super) point: DVector<f64>,
    /// of the parameters themselves, SI
    pub(super) covariance: DMatrix<f64>,
    /// mean squared weighted residual at the start and at the end
    pub(super) cost: (f64, f64),
}

type Node = SVector<f64, STATE>;

/// One segment's share of the normal equations, its node eliminated.
struct Share {
    normal: DMatrix<f64>,
    score: DVector<f64>,
    /// node's step: `own + by_parameters * step of the parameters`
    own: Node,
    by_parameters: OMatrix<f64, Const<STATE>, Dyn>,
}

/// Steps of a node for numerical derivatives: m/s, rad, rad/s. Chosen; not measured.
const NODE_STEP: f64 = 1e-4;
/// The search ends at a step that lowers the cost by less than this share. Chosen; not measured.
const SETTLED: f64 = 1e-4;

pub(super) fn solve(
    (traces, noise): (&[Trace], &[StateNoise]),
    segments: &[Segment],
    unknowns: &Unknowns,
    settings: &RefitSettings,
) -> Result<Solution, RefitError> {
    let mut point = unknowns.start();
    let mut nodes = vec![[0.0; STATE]; segments.len()];
    let prior: Vec<Node> = noise.iter().map(node_precision).collect();
    let first = residuals(&unknowns.base(&point), traces, segments, &nodes)?;
    let weights = weights(&first, segments);
    let start_cost = cost(&first, &weights, settings.huber);
    let mut last_cost = start_cost;
    let mut covariance = None;
    for _ in 0..settings.passes {
        let shares = shares((traces, &prior), segments, (unknowns, &point), &nodes, (&weights, settings))?;
        let size = unknowns.len();
        let (mut normal, mut score) = (DMatrix::zeros(size, size), DVector::zeros(size));
        for share in &shares {
            normal += &share.normal;
            score += &share.score;
        }
        let factor = scaled_cholesky(&normal).ok_or(RefitError::NotDetermined)?;
        covariance = Some(sandwich(&factor, &shares));
        let step = &factor * &score;
        let moved = &point + &step;
        let moved_nodes: Vec<[f64; STATE]> = nodes
            .iter()
            .zip(&shares)
            .map(|(node, share)| {
                let by = share.own + &share.by_parameters * &step;
                std::array::from_fn(|index| node[index] + by[index])
            })
            .collect();
        let after = residuals(&unknowns.base(&moved), traces, segments, &moved_nodes)?;
        let next_cost = cost(&after, &weights, settings.huber);
        if next_cost.is_nan() || next_cost > last_cost {
            break;
        }
        (point, nodes) = (moved, moved_nodes);
        let gained = last_cost - next_cost;
        last_cost = next_cost;
        if gained < SETTLED * last_cost {
            break;
        }
    }
    let slope = unknowns.slope(&point);
    let covariance = covariance.ok_or(RefitError::NotDetermined)?;
    let covariance = &slope * covariance * slope.transpose();
    Ok(Solution { point, covariance, cost: (start_cost, last_cost) })
}

fn node_precision(noise: &StateNoise) -> Node {
    let of = |std: f64| if std > 0.0 { std.powi(-2) } else { 0.0 };
    Node::from_fn(|index, _| match index {
        0..3 => of(noise.velocity_m_s),
        3..6 => of(noise.attitude_rad),
        _ => of(noise.rates_rad_s),
    })
}

fn residuals(
    base: &crate::diagnose::base::Base,
    traces: &[Trace],
    segments: &[Segment],
    nodes: &[[f64; STATE]],
) -> Result<Vec<DVector<f64>>, RefitError> {
    let shooter = Shooter::new(base, traces)?;
    segments
        .par_iter()
        .zip(nodes)
        .map(|(segment, node)| Ok(shooter.residual(&traces[segment.flight], segment, node)?))
        .collect()
}

/// Precision of each entry by its place in the segment, because errors grow from the node on. The median is used, so
/// that a few bad segments have no influence.
fn weights(residuals: &[DVector<f64>], segments: &[Segment]) -> DVector<f64> {
    let length = segments.iter().map(|segment| STATE * segment.comparisons).max().unwrap_or(0);
    DVector::from_fn(length, |entry, _| {
        let mut sizes: Vec<f64> =
            residuals.iter().filter_map(|of| of.get(entry)).map(|value| value.abs()).collect();
        let std = crate::stats::normal_sigma(&mut sizes);
        if std > 0.0 { std.powi(-2) } else { 0.0 }
    })
}

/// Huber's weight of one entry.
fn huber(value: f64, precision: f64, bound: f64) -> f64 {
    let size = value.abs() * precision.sqrt();
    if size <= bound { precision } else { precision * bound / size }
}

fn cost(residuals: &[DVector<f64>], weights: &DVector<f64>, bound: f64) -> f64 {
    let (mut sum, mut count) = (0.0, 0);
    for residual in residuals {
        for (value, precision) in residual.iter().zip(weights.iter()) {
            let size = value.abs() * precision.sqrt();
            sum += if size <= bound { size * size } else { bound * (2.0 * size - bound) };
            count += 1;
        }
    }
    sum / f64::from(u32::try_from(count.max(1)).unwrap_or(u32::MAX))
}

/// Slopes by differences, forward for nodes and parameters alike.
fn shares(
    (traces, prior): (&[Trace], &[Node]),
    segments: &[Segment],
    (unknowns, point): (&Unknowns, &DVector<f64>),
    nodes: &[[f64; STATE]],
    (weights, settings): (&DVector<f64>, &RefitSettings),
) -> Result<Vec<Share>, RefitError> {
    let here = Shooter::new(&unknowns.base(point), traces)?;
    let moved: Vec<(Shooter, f64)> = (0..unknowns.len())
        .map(|index| {
            let mut moved = point.clone();
            moved[index] += unknowns.step(index);
            Ok((Shooter::new(&unknowns.base(&moved), traces)?, unknowns.step(index)))
        })
        .collect::<Result<_, RefitError>>()?;
    segments
        .par_iter()
        .zip(nodes)
        .map(|(segment, node)| {
            let trace = &traces[segment.flight];
            let residual = here.residual(trace, segment, node)?;
            let mut by_node = DMatrix::zeros(residual.len(), STATE);
            for index in 0..STATE {
                let mut other = *node;
                other[index] += NODE_STEP;
                let slope = (here.residual(trace, segment, &other)? - &residual) / NODE_STEP;
                by_node.set_column(index, &slope);
            }
            let mut by_parameters = DMatrix::zeros(residual.len(), moved.len());
            for (index, (shooter, step)) in moved.iter().enumerate() {
                let slope = (shooter.residual(trace, segment, node)? - &residual) / *step;
                by_parameters.set_column(index, &slope);
            }
            let weights =
                DVector::from_fn(residual.len(), |i, _| huber(residual[i], weights[i], settings.huber));
            let prior = (&prior[segment.flight], &Node::from(*node));
            eliminated(&residual, &weights, (&by_node, &by_parameters), prior)
                .ok_or(RefitError::NotDetermined)
        })
        .collect()
}

/// Normal equations after elimination of the node.
fn eliminated(
    residual: &DVector<f64>,
    weights: &DVector<f64>,
    (by_node, by_parameters): (&DMatrix<f64>, &DMatrix<f64>),
    (prior, node): (&Node, &Node),
) -> Option<Share> {
    let weighed = |matrix: &DMatrix<f64>| {
        let mut out = matrix.clone();
        for (mut row, weight) in out.row_iter_mut().zip(weights.iter()) {
            row *= *weight;
        }
        out
    };
    let (weighed_node, weighed_parameters) = (weighed(by_node), weighed(by_parameters));
    let mut own: SMatrix<f64, STATE, STATE> = SMatrix::zeros();
    own.copy_from(&by_node.tr_mul(&weighed_node));
    own += SMatrix::from_diagonal(prior);
    let inverse = own.cholesky()?.inverse();
    // the prior pulls the node back to the measured state
    let mut pull = Node::zeros();
    pull.copy_from(&weighed_node.tr_mul(residual));
    let pull = -(pull + prior.component_mul(node));
    let mut cross = OMatrix::<f64, Const<STATE>, Dyn>::zeros(by_parameters.ncols());
    cross.copy_from(&weighed_node.tr_mul(by_parameters));
    let normal = by_parameters.tr_mul(&weighed_parameters) - cross.tr_mul(&(inverse * &cross));
    let score = -weighed_parameters.tr_mul(residual) - cross.tr_mul(&(inverse * pull));
    Some(Share { normal, score, own: inverse * pull, by_parameters: -(inverse * cross) })
}

/// Inverse of a normal matrix of parameters with different scales.
fn scaled_cholesky(normal: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let scale = normal.diagonal().map(|value| if value > 0.0 { value.sqrt().recip() } else { 1.0 });
    let scaled =
        DMatrix::from_fn(normal.nrows(), normal.ncols(), |i, j| normal[(i, j)] * scale[i] * scale[j]);
    let inverse = scaled.cholesky()?.inverse();
    Some(DMatrix::from_fn(normal.nrows(), normal.ncols(), |i, j| inverse[(i, j)] * scale[i] * scale[j]))
}

/// Covariance from the scatter of the segments' scores (sandwich).
fn sandwich(inverse: &DMatrix<f64>, shares: &[Share]) -> DMatrix<f64> {
    let mut meat = DMatrix::zeros(inverse.nrows(), inverse.ncols());
    for share in shares {
        meat += &share.score * share.score.transpose();
    }
    inverse * meat * inverse
}
