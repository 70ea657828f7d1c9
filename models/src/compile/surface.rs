//! Triangles whose corners are vertices with all that belongs to them.

use std::collections::{HashMap, HashSet};

use mesh_format::NORMAL_ONE;

use super::space::Space;
use super::{Looks, Options};
use crate::{Model, NO_NORMAL, polygon};

/// Cosine of the angle between two faces from which on the edge between them stays sharp: 60°.
const CREASE: f32 = 0.5;
/// Faces around a vertex up to which edges are told apart; with more, all are one surface.
const FACES_TOLD_APART: usize = 64;

/// A vertex. Normals and colours are there if the file keeps the vertices'.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct Vertex {
    pub(super) position: [u16; 3],
    pub(super) normal: Option<[i8; 3]>,
    pub(super) colour: Option<[u8; 3]>,
}

/// What a triangle looks like, and which of its edges are the model's: those within a polygon are not.
#[derive(Debug, Clone, Copy)]
pub(super) struct FaceLook {
    pub(super) normal: [i8; 3],
    pub(super) colour: [u8; 3],
    /// From corner 0 to 1, 1 to 2, 2 to 0.
    pub(super) outline: [bool; 3],
}

/// A line by its ends' positions, the lesser first.
pub(super) type Ends = [[u16; 3]; 2];

/// Returns the line between two positions.
pub(super) fn ends(from: [u16; 3], to: [u16; 3]) -> Ends {
    [from.min(to), from.max(to)]
}

/// A model's triangles and lines.
#[derive(Debug, Default)]
pub(super) struct Surface {
    pub(super) vertices: Vec<Vertex>,
    /// Corners, counter-clockwise from outside.
    pub(super) faces: Vec<[u32; 3]>,
    pub(super) looks: Vec<FaceLook>,
    /// Lines that the model has itself and that are no triangle's side, each once.
    pub(super) lines: Vec<[u32; 2]>,
    /// The triangles' sides that are lines of the model; `None` without lines: the outlines are its edges then.
    pub(super) sides: Option<HashSet<Ends>>,
    /// Triangles without area.
    pub(super) left_out: usize,
    indices: HashMap<Vertex, u32>,
}

impl Surface {
    pub(super) fn new(model: &Model, space: &Space, options: &Options) -> Self {
        let numbers: Vec<[u16; 3]> = model.positions.iter().map(|position| space.numbers(*position)).collect();
        let normals = face_normals(model, options.clockwise);
        let smooth = options.looks != Looks::Flat && !model.corners.is_empty();
        let corner_normals = if smooth { corner_normals(model, &numbers, &normals) } else { Vec::new() };
        let mut surface = Self::default();
        for (face, range) in model.face_ranges().enumerate() {
            let corners = &model.corners[range.clone()];
            let colour = bytes(model.face_colour(face, corners));
            let vertex = |at: usize| Vertex {
                position: numbers[corners[at] as usize],
                normal: corner_normals.get(range.start + at).map(|normal| signed(*normal)),
                colour: smooth.then(|| match &model.colours {
                    Some(colours) => bytes(colours[corners[at] as usize]),
                    None => colour,
                }),
            };
            let last = corners.len() - 1;
            for second in 1..last {
                let third = second + 1;
                let outline = [second == 1, true, third == last];
                let (at, outline) = if options.clockwise {
                    ([0, third, second], [outline[2], outline[1], outline[0]])
                } else {
                    ([0, second, third], outline)
                };
                let look = FaceLook { normal: signed(normals[face]), colour, outline };
                surface.add_face(at.map(vertex), look);
            }
        }
        surface.add_lines(model, &numbers);
        surface
    }

    fn add_face(&mut self, vertices: [Vertex; 3], look: FaceLook) {
        let [a, b, c] = vertices.map(|vertex| vertex.position);
        if a == b || b == c || c == a {
            self.left_out += 1;
            return;
        }
        let corners = vertices.map(|vertex| self.index(vertex));
        self.faces.push(corners);
        self.looks.push(look);
    }

    fn add_lines(&mut self, model: &Model, numbers: &[[u16; 3]]) {
        if model.lines.is_empty() {
            return;
        }
        let position = |vertex: u32| self.vertices[vertex as usize].position;
        let sides = self.faces.iter().flat_map(|[a, b, c]| [[*a, *b], [*b, *c], [*c, *a]]);
        let sides: HashSet<Ends> = sides.map(|[from, to]| ends(position(from), position(to))).collect();
        let mut seen = HashSet::new();
        for line in &model.lines {
            let [from, to] = line.map(|end| numbers[end as usize]);
            if from != to && seen.insert(ends(from, to)) && !sides.contains(&ends(from, to)) {
                // Beside faces, what a line's vertices look like is not looked at; all have the same.
                let line = [from, to].map(|position| self.index(Vertex { position, normal: None, colour: None }));
                self.lines.push(line);
            }
        }
        if !seen.is_empty() {
            seen.retain(|line| sides.contains(line));
            self.sides = Some(seen);
        }
    }

    fn index(&mut self, vertex: Vertex) -> u32 {
        let next = self.vertices.len() as u32;
        let index = *self.indices.entry(vertex).or_insert(next);
        if index == next {
            self.vertices.push(vertex);
        }
        index
    }
}

/// Returns each face's unit normal; zeros where it has no area.
fn face_normals(model: &Model, clockwise: bool) -> Vec<[f32; 3]> {
    let side = if clockwise { -1.0 } else { 1.0 };
    let mut polygon = Vec::new();
    model
        .faces()
        .map(|corners| {
            polygon.clear();
            polygon.extend(corners.iter().map(|corner| model.positions[*corner as usize]));
            polygon::normal(&polygon).map(|part| (side * part) as f32)
        })
        .collect()
}

/// Returns each corner's normal: the file's own, or the mean of the faces around that lie within 60° of its face.
fn corner_normals(model: &Model, numbers: &[[u16; 3]], normals: &[[f32; 3]]) -> Vec<[f32; 3]> {
    let mut around: HashMap<[u16; 3], Vec<u32>> = HashMap::new();
    if model.corner_normals.is_empty() || model.corner_normals.contains(&NO_NORMAL) {
        for (face, corners) in model.faces().enumerate() {
            for corner in corners {
                around.entry(numbers[*corner as usize]).or_default().push(face as u32);
            }
        }
    }
    let mut result = Vec::with_capacity(model.corners.len());
    for (face, range) in model.face_ranges().enumerate() {
        let own = normals[face];
        for at in range {
            let given = model.corner_normals.get(at).and_then(|index| model.normals.get(*index as usize));
            // Stated normals point outwards whichever way the corners go; most programs state them so.
            let normal = given.copied().unwrap_or_else(|| {
                let faces = around.get(&numbers[model.corners[at] as usize]).map_or(&[][..], Vec::as_slice);
                let tell_apart = faces.len() <= FACES_TOLD_APART;
                let sum = faces.iter().map(|face| normals[*face as usize]).fold([0.0f32; 3], |sum, other| {
                    let cosine: f32 = (0..3).map(|axis| own[axis] * other[axis]).sum();
                    if tell_apart && cosine < CREASE { sum } else { [0, 1, 2].map(|axis| sum[axis] + other[axis]) }
                });
                crate::model::direction(sum.map(f64::from))
            });
            result.push(normal);
        }
    }
    result
}

/// Returns a colour of 0 to 1 in 0…255.
pub(super) fn bytes(colour: [f32; 3]) -> [u8; 3] {
    colour.map(|part| (part * 255.0).round() as u8)
}

/// Returns a normal in 8 bits a part.
fn signed(normal: [f32; 3]) -> [i8; 3] {
    normal.map(|part| (part * f32::from(NORMAL_ONE)).round() as i8)
}
