//! The scene's nodes, and where each puts its mesh.

use ::gltf::Node;

use super::{GltfProblem, primitive};
use crate::error::quoted;
use crate::model::direction;
use crate::number::finite;
use crate::{Model, Problem};

/// Levels of nodes that are followed.
const DEPTH_MAX: usize = 256;

/// Where in the tree of nodes the reader is.
pub(super) struct Walk {
    depth: usize,
    /// By node: whether it was visited.
    seen: Vec<bool>,
}

impl Walk {
    pub(super) fn new(nodes: usize) -> Self {
        Self { depth: 0, seen: vec![false; nodes] }
    }
}

/// A node's space in the scene: x, y, z, and the origin, in the scene's coordinates.
pub(super) struct Placed {
    axes: [[f64; 3]; 3],
    origin: [f64; 3],
}

impl Placed {
    pub(super) const IDENTITY: Self =
        Self { axes: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], origin: [0.0; 3] };

    /// Returns a child's space.
    fn child(&self, node: &Node<'_>) -> Self {
        let [x, y, z, origin] = node.transform().matrix().map(|[x, y, z, _]| [x, y, z].map(f64::from));
        Self { axes: [x, y, z].map(|axis| self.turned(axis)), origin: self.moved(origin) }
    }

    fn turned(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        [0, 1, 2].map(|row| self.axes[0][row] * x + self.axes[1][row] * y + self.axes[2][row] * z)
    }

    fn moved(&self, position: [f64; 3]) -> [f64; 3] {
        let turned = self.turned(position);
        [0, 1, 2].map(|row| turned[row] + self.origin[row])
    }

    /// Returns a position in the scene.
    pub(super) fn position(&self, position: [f64; 3]) -> Result<[f64; 3], Problem> {
        let [x, y, z] = self.moved(position);
        Ok([finite(x)?, finite(y)?, finite(z)?])
    }

    /// Returns a normal in the scene: by the cofactors, so that it stays upright under any scaling.
    pub(super) fn normal(&self, [x, y, z]: [f64; 3]) -> [f32; 3] {
        let [a, b, c] = &self.axes;
        let (bc, ca, ab) = (cross(b, c), cross(c, a), cross(a, b));
        let side = if self.mirrors() { -1.0 } else { 1.0 };
        let normal = [0, 1, 2].map(|row| side * (bc[row] * x + ca[row] * y + ab[row] * z));
        if normal.iter().all(|part| part.is_finite()) { direction(normal) } else { [0.0; 3] }
    }

    /// Returns whether faces are turned round.
    pub(super) fn mirrors(&self) -> bool {
        let [a, b, c] = &self.axes;
        let bc = cross(b, c);
        a[0] * bc[0] + a[1] * bc[1] + a[2] * bc[2] < 0.0
    }
}

fn cross(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Adds a node's mesh and those of its children to the model; an error comes with the part it is about.
pub(super) fn add(
    node: &Node<'_>,
    parent: &Placed,
    walk: &mut Walk,
    blob: &[u8],
    model: &mut Model,
) -> Result<(), (String, Problem)> {
    let name = || format!("node {} `{}`", node.index(), quoted(node.name().unwrap_or_default()));
    if walk.depth >= DEPTH_MAX {
        return Err((name(), GltfProblem::Depth { most: DEPTH_MAX }.into()));
    }
    // A second parent would make a circle, or more copies than there are bytes in the file.
    if std::mem::replace(&mut walk.seen[node.index()], true) {
        return Err((name(), GltfProblem::SecondParent.into()));
    }
    let placed = parent.child(node);
    if let Some(mesh) = node.mesh() {
        for primitive in mesh.primitives() {
            primitive::add(&primitive, &placed, blob, model).map_err(|problem| {
                let mesh_name = quoted(mesh.name().unwrap_or_default());
                (format!("mesh {} `{mesh_name}`, primitive {}", mesh.index(), primitive.index()), problem)
            })?;
        }
    }
    walk.depth += 1;
    node.children().try_for_each(|child| add(&child, &placed, walk, blob, model))?;
    walk.depth -= 1;
    Ok(())
}
