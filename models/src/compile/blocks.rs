//! Cuts triangles and lines into blocks.

use std::collections::{HashMap, HashSet};

use mesh_format::{BlockData, EDGES_MAX, FACES_MAX, VERTICES_MAX};

use super::surface::{FaceLook, Surface, Vertex, ends};

/// Returns the blocks of a surface's triangles, taken in `order`, with those of its lines that are their sides.
pub(super) fn of_faces(surface: &Surface, order: &[u32]) -> Vec<BlockData> {
    let mut cutter = Cutter::new(surface);
    let mut edges = HashSet::new();
    for face in order {
        let (corners, look) = (surface.faces[*face as usize], surface.looks[*face as usize]);
        cutter.make_room(&corners, |block| block.corners.len() < FACES_MAX);
        let local = corners.map(|corner| cutter.local(corner));
        cutter.block.corners.push(local);
        let FaceLook { normal, colour, outline } = look;
        cutter.block.face_normals.push(normal);
        cutter.block.face_colours.push(colour);
        for (from, to) in [(0, 1), (1, 2), (2, 0)] {
            // By position: where looks change, an edge's two faces have vertices of their own.
            let [start, end] = [from, to].map(|end| surface.vertices[corners[end] as usize].position);
            let ends = ends(start, end);
            let is_edge = surface.sides.as_ref().map_or(outline[from], |sides| sides.contains(&ends));
            if is_edge && edges.insert(ends) {
                cutter.block.edges.push([local[from], local[to]]);
            }
        }
    }
    cutter.finish()
}

/// Returns the blocks of the lines that are no triangle's side.
pub(super) fn of_lines(surface: &Surface) -> Vec<BlockData> {
    let mut cutter = Cutter::new(surface);
    for ends in &surface.lines {
        cutter.make_room(ends, |block| block.edges.len() < EDGES_MAX);
        let local = ends.map(|end| cutter.local(end));
        cutter.block.edges.push(local);
    }
    cutter.finish()
}

/// The block in the making, and those before it.
struct Cutter<'a> {
    surface: &'a Surface,
    blocks: Vec<BlockData>,
    block: BlockData,
    /// Where the surface's vertices are in the block.
    places: HashMap<u32, u8>,
}

impl<'a> Cutter<'a> {
    fn new(surface: &'a Surface) -> Self {
        Self { surface, blocks: Vec::new(), block: BlockData::default(), places: HashMap::new() }
    }

    /// Starts a new block if these vertices, or one thing more, do not go into this one.
    fn make_room(&mut self, vertices: &[u32], one_more_goes: impl Fn(&BlockData) -> bool) {
        let new = vertices.iter().filter(|vertex| !self.places.contains_key(vertex)).count();
        if self.places.len() + new > VERTICES_MAX || !one_more_goes(&self.block) {
            self.end_block();
        }
    }

    /// Returns where a vertex is in the block, after putting it there if need be.
    fn local(&mut self, vertex: u32) -> u8 {
        if let Some(place) = self.places.get(&vertex) {
            return *place;
        }
        // `make_room` has seen to it that this is below 256.
        let place = self.block.positions.len() as u8;
        let Vertex { position, normal, colour } = self.surface.vertices[vertex as usize];
        self.block.positions.push(position);
        self.block.normals.push(normal.unwrap_or_default());
        self.block.colours.push(colour.unwrap_or_default());
        self.places.insert(vertex, place);
        place
    }

    fn end_block(&mut self) {
        self.places.clear();
        let block = std::mem::take(&mut self.block);
        if !block.positions.is_empty() {
            self.blocks.push(block);
        }
    }

    fn finish(mut self) -> Vec<BlockData> {
        self.end_block();
        self.blocks
    }
}
