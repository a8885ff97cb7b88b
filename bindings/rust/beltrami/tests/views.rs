//! Views of the caller's memory: what they hold, and what they refuse.

use beltrami::{ErrorKind, View, ViewMut};

/// All items, as both ways to them have them.
fn items<const N: usize>(view: &View<'_, f32, N>) -> Vec<[f32; N]> {
    let items: Vec<_> = view.iter().collect();
    assert!(items.iter().copied().map(Some).eq((0..view.len()).map(|index| view.get(index))));
    items
}

#[test]
fn a_view_of_arrays_is_those_arrays() {
    let arrays = [[1.0_f32, 2.0], [3.0, 4.0]];
    let view = View::from(arrays.as_slice());
    assert_eq!(items(&view), arrays);
    assert_eq!(view.get(2), None);
    assert_eq!(format!("{view:?}"), "[[1.0, 2.0], [3.0, 4.0]]");
}

#[test]
fn flat_numbers_are_taken_in_whole_items() {
    let numbers = [1.0_f32, 2.0, 3.0, 4.0, 5.0, 6.0];
    assert_eq!(items(&View::<_, 3>::from_flat(&numbers).unwrap())[1], [4.0, 5.0, 6.0]);
    assert!(View::<f32, 3>::from_flat(&[]).unwrap().is_empty());
    let refused = View::<_, 3>::from_flat(&numbers[1..]).unwrap_err();
    assert_eq!(refused.kind, ErrorKind::InvalidArgument);
}

#[test]
fn strides_reach_to_the_last_number_and_no_further() {
    let numbers: Vec<f32> = (0..11).map(|i| i as f32).collect();
    let strided = |offset, stride, len| View::<_, 3>::strided(&numbers, offset, stride, len);
    assert_eq!(items(&strided(0, 4, 3).unwrap())[2], [8.0, 9.0, 10.0]);
    assert_eq!(items(&strided(3, 5, 2).unwrap())[1], [8.0, 9.0, 10.0]);
    assert!(strided(1, 4, 3).is_err());
    assert!(strided(0, 4, 4).is_err());
    assert!(strided(0, 2, 2).is_err(), "items overlap");
    assert!(strided(12, 3, 0).unwrap().is_empty(), "nothing is looked at");
    assert!(strided(9, 3, 1).is_err());
    assert!(strided(usize::MAX, 3, 1).is_err());
    assert!(strided(0, usize::MAX, 3).is_err());
    assert_eq!(items(&strided(8, usize::MAX, 1).unwrap()), [[8.0, 9.0, 10.0]], "no next item");
    assert!(strided(0, usize::MAX, 0).unwrap().is_empty());
    assert!(strided(0, 3, usize::MAX).is_err());
}

#[test]
fn a_field_is_found_wherever_it_lies() {
    let items_of_tuples = [(1_u8, [1.0_f32, 2.0], 'a'), (2, [3.0, 4.0], 'b')];
    let view = View::from_field(&items_of_tuples, |item| &item.1).unwrap();
    assert_eq!(items(&view), [[1.0, 2.0], [3.0, 4.0]]);
    let none: [(u8, [f32; 2]); 0] = [];
    assert!(View::from_field(&none, |item| &item.1).unwrap().is_empty());
}

#[test]
fn a_field_must_be_the_same_part_of_every_item() {
    struct Two {
        a: [f32; 2],
        b: [f32; 2],
    }
    let twos = [Two { a: [1.0; 2], b: [2.0; 2] }, Two { a: [3.0; 2], b: [4.0; 2] }];
    let mixed = View::from_field(&twos, |two| if two.a[0] < 2.0 { &two.a } else { &two.b });
    assert_eq!(mixed.unwrap_err().kind, ErrorKind::InvalidArgument);
    let elsewhere = View::from_field(&twos, |_| &[0.0_f32; 2]);
    assert!(elsewhere.is_err(), "a constant is no part of an item");
    let boxes = [Box::new([0.0_f32; 2]), Box::new([1.0; 2])];
    assert!(View::from_field(&boxes, |item| item).is_err(), "what a box points to is not in it");
}

#[test]
fn mutable_views_are_checked_alike() {
    let mut numbers = [0.0_f32; 11];
    assert!(ViewMut::<_, 3>::strided(&mut numbers, 0, 4, 3).is_ok());
    assert!(ViewMut::<_, 3>::strided(&mut numbers, 1, 4, 3).is_err());
    assert_eq!(ViewMut::<_, 3>::strided(&mut numbers, 8, usize::MAX, 1).unwrap().len(), 1);
    assert!(ViewMut::<_, 2>::from_flat(&mut numbers).is_err());
    let mut boxes = [Box::new([0.0_f32; 2])];
    assert!(ViewMut::from_field(&mut boxes, |item| item.as_mut()).is_err());
    let mut pairs = [(0_u64, [0.0_f32; 2]); 3];
    assert_eq!(ViewMut::from_field(&mut pairs, |pair| &mut pair.1).unwrap().len(), 3);
}
